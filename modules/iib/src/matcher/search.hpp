// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#ifndef OPENCV_IIB_MATCHER_SEARCH_HPP
#define OPENCV_IIB_MATCHER_SEARCH_HPP

#include "pair_scan.hpp"

namespace cv {
namespace iib {

/* Searches run on several threads; results do not depend on their number. */

/** Finds the k nearest for each query; with `mutual`, only pairs that are among the k nearest in both directions. A row
stays empty unless its least distance is below maxRatio times the second, if that is under 1. */
KnnTable findNearest(const SearchInput& input, int k, bool mutual, float maxRatio, SearchCost& cost);

//! Puts the nearest of each query into a table, which may hold some of other train codes, of lower indices, already.
SearchCost addNearest(const SearchInput& input, KnnTable& forQueries);

//! Finds all within a radius, in ascending order for each query.
std::vector<std::vector<MatchKey>> findWithin(const SearchInput& input, int radius, SearchCost& cost);

}  // namespace iib
}  // namespace cv

#endif
