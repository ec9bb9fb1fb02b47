// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#pragma once

#include "../precomp.hpp"

namespace cv {
namespace iib {

/** The grey of a BGR or BGRA image of 8U or 16U: (3735 B + 19235 G + 9798 R + 2^14) >> 15, as cvtColor's in OpenCV 4.6. Not
 cvtColor itself, whose bits versions and hardware layers (HAL) change. */
Mat greyOf(const Mat& image);

}  // namespace iib
}  // namespace cv
