// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#ifndef OPENCV_IIB_MATCHER_SEARCH_HPP
#define OPENCV_IIB_MATCHER_SEARCH_HPP

#include "knn_table.hpp"
#include "packed_codes.hpp"
#include "pruning.hpp"
#include "search_blocks.hpp"

namespace cv {
namespace iib {

//! Work of a search, in bits.
struct SearchCost
{
    SearchCost() : compared(0), all(0) {}
    SearchCost& operator+=(const SearchCost& other)
    {
        compared += other.compared;
        all += other.all;
        return *this;
    }
    uint64 compared, all;
};

//! What a search looks for and among which pairs.
struct SearchInput
{
    SearchInput(const PackedCodes& trains_, const Mat& queries_, const PruningPolicy& policy_,
            const std::vector<Mat>& masks_, const SearchBlocks& blocks_)
        : trains(trains_), queries(queries_), policy(policy_), masks(masks_), blocks(blocks_), hidden(0),
          firstIndex(0)
    {
    }

    const PackedCodes& trains;
    const Mat& queries;             //!< CV_8U, as wide as the train codes
    const PruningPolicy& policy;    //!< made for the layout of the train codes
    const std::vector<Mat>& masks;  //!< none, or one for each image, empty or queries x rows(image)
    const SearchBlocks& blocks;
    const std::vector<bool>* hidden;  //!< of each image, whether its rows are left out; null: none is
    size_t firstIndex;                //!< what the first of the train codes is called in results
};

/** Finds the k nearest for each query; with `mutual`, only pairs that are among the k nearest in both directions. A row
stays empty unless its least distance is below maxRatio times the second, if that is under 1. */
KnnTable findNearest(const SearchInput& input, int k, bool mutual, float maxRatio, SearchCost& cost);

//! Finds all within a radius, in ascending order for each query.
std::vector<std::vector<MatchKey>> findWithin(const SearchInput& input, int radius, SearchCost& cost);

}  // namespace iib
}  // namespace cv

#endif
