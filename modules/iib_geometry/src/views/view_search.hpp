// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "image_views.hpp"

namespace cv::iib {

//! An affine map between two images, and how many matches agree with it.
struct ViewCandidate
{
    Matx33d map;  //!< from pixels of image 1 to pixels of image 2
    int support;  //!< matches whose neighbours move as the map has it

    bool operator<(const ViewCandidate& other) const { return support > other.support; }
};

/** Looks for the views of two images in which they match: relative scales from 1/4 to 4 with any rotation, then tilts.
@param maxTilt largest tilt between the images; up to 2 no view is tilted.
@param isAnswer called with candidates of much support as soon as they are found, and with the best others at the end; true ends the search. The second
    argument is the number of pairs of views, upright and turned, that were compared so far.
@return the number of those that were compared in all. */
int searchViews(const ImageViews& first, const ImageViews& second, double maxTilt,
        const std::function<bool(const ViewCandidate&, int)>& isAnswer);

}  // namespace cv::iib
