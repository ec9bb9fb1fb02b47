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

//! The bits of one level of MAPPING_BOXES. @param angle in degrees; negative if the boxes are upright.
std::vector<bool> boxLevelBits(const cv::iib::IIBDescriptorExtractor& iib, const cv::Mat& grey,
        const cv::KeyPoint& keypoint, float angle, int level);

}  // namespace oracle

#endif
