// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#ifndef OPENCV_IIB_MATCHER_PACKED_CODES_HPP
#define OPENCV_IIB_MATCHER_PACKED_CODES_HPP

#include "kernels/hamming.hpp"
#include "knn_table.hpp"

namespace cv {
namespace iib {

//! Work of a search, in bits.
struct SearchCost
{
    SearchCost() : compared(0), all(0) {}
    uint64 compared, all;
};

//! Where pairs are given up on the way from coarse to fine; with no stops, never.
struct PruningPolicy
{
    std::vector<PruneStage> stops;
    int limit;   //!< with a single stop, the most bits that may differ there
    int margin;  //!< if >= 0, the limit of a query comes down to its least difference there plus this

    PruningPolicy() : limit(INT_MAX), margin(-1) {}
};

//! Every pair is compared to the end.
PruningPolicy exactPlan();
//! A pair within `radius` is found; levels whose sum is beyond it end the comparison.
PruningPolicy radiusPlan(const CodeLayout& layout, int radius);
//! The paper's rule; one threshold for each level but the last.
PruningPolicy thresholdPlan(const CodeLayout& layout, const std::vector<float>& thresholds);
//! Bounds relative to the query's least distances so far.
PruningPolicy adaptivePlan(const CodeLayout& layout);

//! Packed train codes of several images, one after the other, and searches among them.
class PackedCodes
{
public:
    explicit PackedCodes(const std::vector<int>& levelSizes);
    PackedCodes(const PackedCodes& other);

    const CodeLayout& layout() const { return format; }
    size_t rows() const { return starts.back(); }
    size_t images() const { return starts.size() - 1; }
    size_t rows(size_t image) const { return starts[image + 1] - starts[image]; }
    //! From a row of all to its image; subtract start(image) for the row in it.
    size_t imageOf(size_t row) const;
    size_t start(size_t image) const { return starts[image]; }

    //! Adds an image's descriptors: CV_8U, layout().bytes() columns, any number of rows. Changes nothing if it throws.
    void add(const Mat& descriptors);
    //! An image's descriptors as they were added.
    Mat descriptors(size_t image) const;

    /** Finds the k nearest for each query; with `mutual`, only pairs that are among the k nearest in both
    directions. A row stays empty unless its least distance is below maxRatio times the second, if that is
    under 1. Masks: none, or one for each image, empty or queries x rows(image). */
    KnnTable nearest(const Mat& queries, const PruningPolicy& plan, int k, bool mutual, float maxRatio,
            const std::vector<Mat>& masks, SearchCost& cost) const;

    //! Finds all within a radius, in ascending order for each query.
    std::vector<std::vector<MatchKey>> within(const Mat& queries, const PruningPolicy& plan, int radius,
            const std::vector<Mat>& masks, SearchCost& cost) const;

private:
    PackedCodes& operator=(const PackedCodes&);
    //! Makes codes have that many rows; the new ones are zeros. Changes nothing if it throws.
    void grow(int groups);

    const CodeLayout format;
    std::vector<size_t> starts;  //!< first row of each image, and the number of all rows
    Mat codes;                   //!< a row a group: aligned, and grown without copying every time
};

}  // namespace iib
}  // namespace cv

#endif
