// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "fitted_transform.hpp"

namespace cv::iib {

/** Standard deviations of the image's corners in the reference, 4 x 1, CV_64F, working pixels.
@param beside displacement of a part of the images beside the transform (deviationBeside).
@param pixel working pixels per pixel in which the matches were refined. */
Mat cornerErrors(const FittedTransform& fitted, const AlignedPoints& points,
        const std::vector<Point2d>& corners, double beside, double pixel);

}  // namespace cv::iib
