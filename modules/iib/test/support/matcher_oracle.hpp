// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#pragma once

#include "../test_precomp.hpp"
#include "../../src/matcher/search.hpp"
#include "random_descriptors.hpp"

namespace opencv_test {

typedef std::vector<std::vector<DMatch>> Matches;

//! CV_8UC1 of 0 and 255, about `share` of them set.
Mat randomMask(uint64 seed, int rows, int cols, double share);

//! Matching as the header defines it, pair by pair.
struct MatcherOracle
{
    std::vector<Mat> images, masks;
    std::vector<int> levelSizes;
    std::vector<float> thresholds;  //!< of THRESHOLD; empty: another mode
    int adaptiveBlock;  //!< ADAPTIVE: train codes that are compared before any is dropped; 0: another mode
    bool crossCheck;
    float maxRatio;
    double compared, all;  //!< bits, after a call

    MatcherOracle() : adaptiveBlock(0), crossCheck(false), maxRatio(1), compared(0), all(0) {}
    Matches knn(const Mat& queries, int k);
    Matches radius(const Mat& queries, int radius);
    Ptr<HierarchicalMatcher> matcher() const;

private:
    Matches candidates(const Mat& queries);
    bool passes(const uchar* query, const uchar* train);
    void keepAdaptive(const Mat& queries, Matches& candidates);
};

//! The library's search in chunks of these sizes: the k nearest, or for k = 0 all within a radius.
Matches searched(const MatcherOracle& oracle, const Mat& queries, int k, int radius, const ScanChunk& chunk,
        SearchCost& cost);

//! Five train images with levels of 2, 8 and 32 bytes; one is empty, one has a single row.
MatcherOracle oracleOfSeveralImages();

//! A mask for each image of oracleOfSeveralImages(), two of them empty: all pairs allowed.
std::vector<Mat> masksOfSeveralImages(const MatcherOracle& oracle, int queries);

void expectEqual(const Matches& expected, const Matches& actual);

void expectSameParameters(const HierarchicalMatcher& a, const HierarchicalMatcher& b);

//! The k nearest by the matcher and by the oracle, and the share of bits that were compared.
void expectKnnAsOracle(HierarchicalMatcher& matcher, MatcherOracle& oracle, const Mat& queries, int k);

}  // namespace opencv_test
