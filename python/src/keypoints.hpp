// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "arrays.hpp"

#include <vector>

namespace iib_python {

//! Columns of an array of keypoints: x, y, size, angle, response, octave, class_id.
enum
{
    KEYPOINT_COLUMNS = 7
};

//! Reads the attributes of objects like cv2.KeyPoint, of any cv2 or none, into rows x KEYPOINT_COLUMNS, CV_32F.
cv::Mat readKeyPoints(nb::sequence objects);

//! Keypoints of an array of 3 (x, y, size), 4 (and the angle) or 7 columns, CV_32F.
//! @throws cv::Exception for another shape or type.
std::vector<cv::KeyPoint> toKeyPoints(const cv::Mat& rows);

//! Matches of an array of 2 columns, index into the first keypoints and into the second, CV_32S.
std::vector<cv::DMatch> toMatches(const cv::Mat& pairs);

cv::Mat toRows(const std::vector<cv::KeyPoint>& keypoints);

}  // namespace iib_python
