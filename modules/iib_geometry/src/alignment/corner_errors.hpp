// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "fitted_transform.hpp"

namespace cv::iib {

/** Standard deviations of the places of the image's corners, 4 x 1, CV_64F, working pixels.
@param beside what parts of the images differ by from the transform.
@param pixel in which the matches were refined, working pixels. */
Mat cornerErrors(const FittedTransform& fitted, const AlignedPoints& points,
        const std::vector<Point2d>& corners, double beside, double pixel);

}  // namespace cv::iib
