// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>

#include "image_views.hpp"

namespace cv::iib {

//! Matches of two images in one pair of views.
struct ViewMatches
{
    Mat points1, points2, covariances, similarities;  //!< as in matchViews
    double logFalseAlarms = std::numeric_limits<double>::infinity();
    double inliers = 0;            //!< estimated number of inliers
    Matx33d map = Matx33d::eye();  //!< affine, fitted to the inliers, from pixels of image 1 to image 2

    bool isDecisive() const { return logFalseAlarms < -25; }  //!< whether no search is needed
};

/** Matches the images themselves, then other views until matches are decisive. These are improved in the views of their map. All compared
views count in the number of false alarms.
@param maxTilt as in matchViews. */
ViewMatches matchInSomeViews(const ImageViews& first, const ImageViews& second, double maxTilt);

}  // namespace cv::iib
