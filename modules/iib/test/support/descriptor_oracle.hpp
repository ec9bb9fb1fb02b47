// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#pragma once

#include "../normalization/normalization_oracle.hpp"
#include "opencv2/iib/descriptor.hpp"

/*
The descriptor once more, from the paper's equations and the header's words: pixel by pixel, cell by
cell, bit by bit. The tests ask the library for the same bits.
*/
namespace oracle {

//! A channel's value at every pixel.
typedef cv::Mat_<int> Channel;

//! atan2(-gy, gx) in ORIENTATION_STEPS a turn, with the library's polynomial; test_orientation.cpp compares it
//! with std::atan2.
int orientation(int gx, int gy);

//! keypoints.size() descriptors of a grey image (CV_8U or CV_16U) and of extra maps of these types, for the extractor's parameters but BORDER_DROP.
cv::Mat describe(const cv::iib::IIBDescriptorExtractor& iib, const cv::Mat& grey,
        const std::vector<cv::Mat>& extra, const std::vector<cv::KeyPoint>& keypoints);

//! Sobel 3x3 of such pixels.
cv::Point gradient(const cv::Mat& image, int y, int x);

//! Up to two reflections by BORDER_REFLECT_101; pixel 0 beyond.
int64 reflectTo(int64 v, int limit);

//! The bits of one level of MAPPING_BOXES. @param angle in degrees; negative if the boxes are upright.
std::vector<bool> boxLevelBits(const cv::iib::IIBDescriptorExtractor& iib, const cv::Mat& grey,
        const cv::KeyPoint& keypoint, float angle, int level);

}  // namespace oracle
