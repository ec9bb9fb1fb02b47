// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "fitted_transform.hpp"

namespace cv::iib {

/** Whether the matches that agree are marks of the sensor, such as hot pixels: single pixels that do not move, while hardly any
larger point does. */
bool areOfTheSensor(const FittedTransform& fitted, const Evidence& evidence);

}  // namespace cv::iib
