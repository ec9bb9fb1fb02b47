// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#ifndef OPENCV_IIB_MATCHER_PAIR_BLOCKS_HPP
#define OPENCV_IIB_MATCHER_PAIR_BLOCKS_HPP

#include "search.hpp"

#include <functional>

namespace cv {
namespace iib {

//! Some queries and train codes that are scanned together; its indices count from the first of each.
struct PairBlock
{
    CodePairs pairs;
    int firstQuery;
    size_t firstTrain, firstIndex;  //!< its row among the train codes, and what results call it
    size_t pairCount;               //!< those that are not masked
};

//! Visits all pairs of queries `from` to `to` with all train codes, block by block: all train codes in ascending order
//! for some queries, then for the next.
void forEachBlock(
        const SearchInput& input, int from, int to, const std::function<void(const PairBlock&)>& visit);

}  // namespace iib
}  // namespace cv

#endif
