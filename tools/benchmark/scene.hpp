// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#ifndef OPENCV_IIB_BENCHMARK_SCENE_HPP
#define OPENCV_IIB_BENCHMARK_SCENE_HPP

#include "opencv2/core.hpp"

namespace iib_tools {

//! A grey image with corners everywhere: blurred noise at two scales.
cv::Mat cornerImage(cv::Size size);

//! FAST corners, spread over the image, with ORB's size, away from the border, where ORB would drop them.
std::vector<cv::KeyPoint> corners(const cv::Mat& image, size_t count);

}  // namespace iib_tools

#endif
