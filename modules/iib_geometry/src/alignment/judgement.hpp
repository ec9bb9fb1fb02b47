// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "fitted_transform.hpp"

namespace cv::iib {

struct Judgement
{
    std::string against;  //!< why the images have no such transform; empty if they have one
    bool isLast;          //!< whether another attempt would give the same verdict
    std::string note;     //!< advice about a transform that was found, or empty
};

/** Standard deviations of the image's corners in the reference, 4 x 1, CV_64F, working pixels (corner_errors.cpp).
@param beside displacement of a part of the images beside the transform (deviationBeside).
@param pixel working pixels per pixel in which the matches were refined. */
Mat cornerErrors(const FittedTransform& fitted, const AlignedPoints& points,
        const std::vector<Point2d>& corners, double beside, double pixel);

/** Whether the matches that agree are marks of the sensor, such as hot pixels: single pixels that do not move, while hardly any
larger point does (sensor_marks.cpp). */
bool areOfTheSensor(const FittedTransform& fitted, const Evidence& evidence);

/** Index of the simplest transform that is true (compare Torr 1998): no richer one explains the matches better, or richer ones belong to
another part of the images. */
size_t simplestTrue(const std::vector<FittedTransform>& all, const Evidence& evidence);

/** @param all the judged transform and the richer ones after it.
@param judged index of the judged transform.
@param errors of the corners, working pixels. */
Judgement judge(
        const std::vector<FittedTransform>& all, size_t judged, const Evidence& evidence, const Mat& errors);

/** Displacement of a part of the images beside the transform, such as moved shadows or depth, working pixels: two thirds of its matches are
nearer. 0 if the part is too small, or is one motion that judge() has a note about. */
double deviationBeside(const FittedTransform& fitted, const Evidence& evidence);

}  // namespace cv::iib
