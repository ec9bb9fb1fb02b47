// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#ifndef OPENCV_IIB_TEST_HESSIAN_ORACLE_HPP
#define OPENCV_IIB_TEST_HESSIAN_ORACLE_HPP

#include "../test_precomp.hpp"

namespace oracle {

//! HessianDetector once more, a whole image a scale and pixel by pixel: the same keypoints, of CV_8U or CV_16U.
std::vector<cv::KeyPoint> findBlobs(const cv::Mat& grey, const cv::iib::HessianDetector& parameters);

//! sigma^4 (Ixx Iyy - Ixy^2) of a normalized image, CV_8U, smoothed by a Gaussian; in units of 40 grey levels. CV_32F.
cv::Mat responsesByDefinition(const cv::Mat& normalized, double sigma);

}  // namespace oracle

#endif
