// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#ifndef OPENCV_IIB_MATCHER_BLOCKED_SEARCH_HPP
#define OPENCV_IIB_MATCHER_BLOCKED_SEARCH_HPP

#include "search.hpp"

namespace cv {
namespace iib {

/* One pass over all pairs, block by block, on several threads. Results do not depend on the number of threads. */

//! Fills the tables with the nearest; forTrains is null when nobody asks for the other direction.
SearchCost searchNearest(const SearchInput& input, KnnTable& forQueries, KnnTable* forTrains);

//! Adds the pairs within a radius to the list of each query.
SearchCost searchWithin(const SearchInput& input, int radius, std::vector<std::vector<MatchKey>>& result);

}  // namespace iib
}  // namespace cv

#endif
