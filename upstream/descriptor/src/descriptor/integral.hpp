// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#pragma once

#include "../precomp.hpp"
#include "kernels/orientation.hpp"

namespace cv { namespace iib {

constexpr int CHANNELS = 4;  //!< of the image; those not in use are computed, but have no bits
constexpr int MAX_VALUE = ORIENTATION_STEPS - 1;  //!< of a channel; gradients of 8-bit images reach 1020

//! The integral image of the channels, CV_32SC4 modulo 2^32, over a rectangle that may leave the image.
Mat integralOf(const Mat& image, Rect area);

}}  // namespace cv::iib
