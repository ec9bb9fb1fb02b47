// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#ifndef OPENCV_IIB_MATCHER_SKIPPING_SEARCH_HPP
#define OPENCV_IIB_MATCHER_SKIPPING_SEARCH_HPP

#include "search.hpp"

namespace cv {
namespace iib {

/** Fills the table with the nearest of each query in all segments, as searchNearest does one after the other, but leaves
out what cannot hold them.

The distance of the first words of two codes is a lower bound of theirs. For each query, the least one of every chunk of
SearchBlocks::codeBlocks is found first; then the chunk with the least of all is searched, and then those whose bound is
not beyond the k-th nearest so far. Some of the queries are searched in full before that: they tell how many words pay, or
that none do. Ties go to the lowest index, whatever the order of the chunks. */
void searchSkipping(const std::vector<SearchInput>& segments, KnnTable& found);

}  // namespace iib
}  // namespace cv

#endif
