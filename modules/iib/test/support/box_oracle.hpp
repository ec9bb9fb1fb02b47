// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#ifndef OPENCV_IIB_TEST_SUPPORT_BOX_ORACLE_HPP
#define OPENCV_IIB_TEST_SUPPORT_BOX_ORACLE_HPP

#include <vector>

#include "opencv2/core.hpp"
#include "opencv2/iib/features.hpp"
#include "opencv2/iib/descriptor.hpp"

namespace oracle {

//! The nearest pixel of an image, CV_8U, CV_16U or CV_32S.
int pixel(const cv::Mat& image, int y, int x);

//! Sobel's, of such pixels.
cv::Point gradient(const cv::Mat& image, int y, int x);

//! BORDER_REFLECT_101, which is never needed more than twice; what is further is the first pixel.
int64 reflectTo(int64 v, int limit);

//! The bits of one level of MAPPING_BOXES. @param angle in degrees; negative if the boxes are upright.
std::vector<bool> boxLevelBits(const cv::iib::IIBDescriptorExtractor& iib, const cv::Mat& grey,
        const cv::KeyPoint& keypoint, float angle, int level);

}  // namespace oracle

#endif
