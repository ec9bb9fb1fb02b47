// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "spread.hpp"

namespace cv::iib {

/** Whether what two images share lies over both of them, such as captions, a frame or a part of the vehicle that carries the camera: there the images
are equal to the pixel, and elsewhere, where both have points, they are not. */
bool isOverlay(const SharedPart& reference, const SharedPart& image);

}  // namespace cv::iib
