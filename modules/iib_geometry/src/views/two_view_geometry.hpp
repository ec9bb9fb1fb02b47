// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

#include "opencv2/core.hpp"

namespace cv::iib {

//! Matches that agree with one fundamental matrix or one homography, and whether that can be chance.
struct TwoViewGeometry
{
    std::vector<uchar> inliers;  //!< a mark for each match; of none if nothing agrees
    double logFalseAlarms;       //!< as iib::logFalseAlarms

    //! @param points1, points2 N x 2, CV_64F, pixels.
    TwoViewGeometry(const Mat& points1, const Mat& points2);

    int count() const { return (int)std::count(inliers.begin(), inliers.end(), 1); }
};

}  // namespace cv::iib
