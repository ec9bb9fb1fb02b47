// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

#include "opencv2/core.hpp"

namespace cv::iib {

//! The inliers of a fundamental matrix or a homography, whichever has fewer false alarms.
struct TwoViewGeometry
{
    std::vector<uchar> inliers;  //!< 1 or 0 for each match; empty if no geometry was found
    double logFalseAlarms;       //!< as iib::logFalseAlarms

    //! @param points1, points2 N x 2, CV_64F, pixels.
    TwoViewGeometry(const Mat& points1, const Mat& points2);

    int count() const { return (int)std::count(inliers.begin(), inliers.end(), 1); }
};

}  // namespace cv::iib
