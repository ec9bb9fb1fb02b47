// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#ifndef OPENCV_IIB_TEST_NORMALIZATION_ORACLE_HPP
#define OPENCV_IIB_TEST_NORMALIZATION_ORACLE_HPP

#include "../support/oracle_pixels.hpp"
#include "../test_precomp.hpp"

namespace oracle {

typedef cv::Mat_<int> Map;

//! Means of 4 x 4 pixels around the corner between four of them, weighted 1, 3, 3, 1 in both directions, rounded.
Map halved(const Map& m);

//! Naive local normalization of CV_8U or CV_16U, with the library's integers.
cv::Mat normalizeLocally(const cv::Mat& grey, double sigma);

//! By definition, with Gaussian filters in floats: 128 + 40 (I - G*I) / (sqrt(G*(I - G*I)^2) + 2) of CV_8U.
cv::Mat normalizeByDefinition(const cv::Mat& grey, double sigma);

}  // namespace oracle

#endif
