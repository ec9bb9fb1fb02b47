// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "evidence.hpp"
#include "fitted_transform.hpp"

namespace cv::iib {

struct Judgement
{
    std::string against;  //!< why the images have no such transform; empty if they have
    bool isLast;          //!< whether another attempt can say nothing else
    std::string note;     //!< what a user should know of a transform that was found, or empty
};

/** Index of the simplest transform that is true (compare Torr 1998): no other one explains the matches better, or those that do are of another
part of the images. */
size_t simplestTrue(const std::vector<FittedTransform>& all, const Evidence& evidence);

/** @param all transforms, those after the judged one of more freedom.
@param judged index of the one that is judged.
@param errors of the corners, working pixels. */
Judgement judge(
        const std::vector<FittedTransform>& all, size_t judged, const Evidence& evidence, const Mat& errors);

/** By how much a part of the images is beside the transform, as by light that moves shadows or by a camera that moved little, working
pixels; 0 if it is no larger than what makes no parallax. */
double deviationBeside(const FittedTransform& fitted, const Evidence& evidence);

}  // namespace cv::iib
