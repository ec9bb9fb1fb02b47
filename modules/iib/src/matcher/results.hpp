// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#ifndef OPENCV_IIB_MATCHER_RESULTS_HPP
#define OPENCV_IIB_MATCHER_RESULTS_HPP

#include "knn_table.hpp"
#include "packed_codes.hpp"

namespace cv {
namespace iib {

/* From neighbours among all train codes to what DescriptorMatcher returns. */

//! The nearest of each query that has one.
void toBestMatches(const PackedCodes& trains, const KnnTable& found, std::vector<DMatch>& matches);

//! A row for each query; with `compact`, only for those that have a match.
void toMatches(const PackedCodes& trains, const KnnTable& found, bool compact,
        std::vector<std::vector<DMatch>>& matches);
void toMatches(const PackedCodes& trains, const std::vector<std::vector<MatchKey>>& found, bool compact,
        std::vector<std::vector<DMatch>>& matches);

//! CV_32S matrices of k columns, -1 where there is no neighbour.
void toArrays(const PackedCodes& trains, const KnnTable& found, int k, OutputArray indices,
        OutputArray distances, OutputArray imageIndices);

}  // namespace iib
}  // namespace cv

#endif
