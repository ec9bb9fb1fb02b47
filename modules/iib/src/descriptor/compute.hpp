// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#pragma once

#include "plan.hpp"

namespace cv { namespace iib {

//! Whether the keypoint's support region, upright or rotated, lies inside the image.
bool isInside(const DescriptorPlan& plan, const KeyPoint& keypoint, Size image);

/** Describes keypoints (paper, algorithm 1). All arguments are checked.
@param extra maps of the image's size.
@param descriptors keypoints.size() rows of plan.bytes, CV_8U, allocated. */
void describe(const DescriptorPlan& plan, const Mat& image, const std::vector<Mat>& extra,
        const std::vector<KeyPoint>& keypoints, Mat& descriptors);

}}  // namespace cv::iib
