// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#pragma once

#include "pair_scan.hpp"

namespace cv { namespace iib {

//! A mask for each image of the index, or none if all are empty; throws where one does not fit.
std::vector<Mat> checkedMasks(InputArrayOfArrays masks, int queries, const PackedCodes& index);

/** Throws StsOutOfRange if results of k columns would be large and mostly empty. @param rows number of train rows. */
void checkPadding(int k, size_t queries, size_t rows);

/* Searches run on several threads; results do not depend on their number. */

/** Finds the k nearest for each query; with `mutual`, only pairs that are among the k nearest in both directions. With
maxRatio < 1, a row stays empty unless its least distance is below maxRatio times the second. */
KnnTable findNearest(const SearchInput& input, int k, bool mutual, float maxRatio);

//! Adds the nearest of each query to a table, which may hold neighbours with lower indices already.
void addNearest(const SearchInput& input, KnnTable& forQueries);

//! Finds all within a radius, in ascending order for each query.
std::vector<std::vector<MatchKey>> findWithin(const SearchInput& input, int radius);

/* Rules that end comparisons early. */

//! Ends pairs whose partial distance exceeds the radius.
PruningPolicy radiusPolicy(const CodeLayout& layout, int radius);
//! The paper's rule; one threshold for each level but the last.
PruningPolicy thresholdPolicy(const CodeLayout& layout, const std::vector<float>& thresholds);
//! Limits relative to the query's least partial distance so far.
PruningPolicy adaptivePolicy(const CodeLayout& layout);

}}  // namespace cv::iib
