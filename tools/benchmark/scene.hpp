// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#ifndef OPENCV_IIB_BENCHMARK_SCENE_HPP
#define OPENCV_IIB_BENCHMARK_SCENE_HPP

#include "opencv2/features2d.hpp"

namespace iib_tools {

//! A grey image with corners everywhere: blurred noise at two scales.
cv::Mat cornerImage(cv::Size size);

//! The scene at another time: darker, with a ramp of light and noise.
cv::Mat relit(const cv::Mat& image);

//! FAST corners, spread over the image, with ORB's size, away from the border, where ORB would drop them.
std::vector<cv::KeyPoint> corners(const cv::Mat& image, size_t count);

//! The descriptors of the keypoints, of which those that the extractor drops are missing.
cv::Mat described(
        const cv::Ptr<cv::Feature2D>& extractor, const cv::Mat& image, std::vector<cv::KeyPoint> keypoints);

}  // namespace iib_tools

#endif
