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
    double inliers = 0;  //!< estimated number of inliers
    Matx33d map =
            Matx33d::eye();  //!< affine, fitted to the inliers, from pixels of image 1 to pixels of image 2

    bool isDecisive() const;  //!< whether no search is needed
};

//! Matches the images themselves. Decisive matches are improved in the views of their map.
ViewMatches matchAsTheyAre(const ImageViews& first, const ImageViews& second);

/** Searches other views for better matches. All compared views count in the number of false alarms.
@param maxTilt as in matchViews. */
void searchMatches(const ImageViews& first, const ImageViews& second, double maxTilt, ViewMatches& best);

}  // namespace cv::iib
