// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#pragma once

#include "search.hpp"

namespace cv {
namespace iib {

/* What a search found, as DescriptorMatcher's calls return it. */

//! The nearest of each query that has one.
void toBestMatches(const PackedCodes& trains, const KnnTable& found, std::vector<DMatch>& matches);

//! Adds a row of the matches of a query; with `compact`, only if it has any.
void addMatches(const PackedCodes& trains, int query, const MatchKey* begin, const MatchKey* end,
        bool compact, std::vector<std::vector<DMatch>>& matches);

//! CV_32S matrices of k columns, -1 where there is no neighbour.
void toArrays(const PackedCodes& trains, const KnnTable& found, int k, OutputArray indices,
        OutputArray distances, OutputArray imageIndices);

}  // namespace iib
}  // namespace cv
