// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>

#include "image_views.hpp"

namespace cv::iib {

//! Matches of two images in one pair of views.
struct ViewMatches
{
    Mat points1, points2, covariances, similarities;  //!< as matchViews has them
    double logFalseAlarms = std::numeric_limits<double>::infinity();
    double right = 0;  //!< number of matches that agree
    Matx33d map = Matx33d::
            eye();  //!< affine, estimated from those that agree, from pixels of image 1 to pixels of image 2

    bool isDecisive() const;  //!< whether nothing else need be tried
};

//! Matches of the images themselves or, where these are decisive and the map between the images is another one, of its views.
ViewMatches matchAsTheyAre(const ImageViews& first, const ImageViews& second);

/** Replaces matches by better ones of other views, if there are any. Counts the views that were compared in the number of false alarms.
@param maxTilt as of matchViews. */
void searchMatches(const ImageViews& first, const ImageViews& second, double maxTilt, ViewMatches& best);

}  // namespace cv::iib
