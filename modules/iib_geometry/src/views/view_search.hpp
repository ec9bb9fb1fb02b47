// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "image_views.hpp"

namespace cv::iib {

//! An affine map between two images, and its support.
struct ViewCandidate
{
    Matx33d map;  //!< from pixels of image 1 to pixels of image 2
    int support;  //!< number of matches whose neighbours agree with the map

    bool operator<(const ViewCandidate& other) const { return support > other.support; }
};

//! Whether one image has so many more pixels that the other is searched for in its parts.
bool isMuchLarger(const ImageViews& first, const ImageViews& second);

/** Searches for views in which two images match: relative scales from 1/4 to 4 at any rotation, then tilts.
@param maxTilt largest tilt between the images; up to 2 no view is tilted.
@param tryCandidate called at once with candidates of high support, at the end with the best others; true ends the search. Its second argument
is the number of pairs of views compared so far, rotations included.
@return the number of pairs compared in all. */
int searchViews(const ImageViews& first, const ImageViews& second, double maxTilt,
        const std::function<bool(const ViewCandidate&, int)>& tryCandidate);

}  // namespace cv::iib
