// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>

#include "opencv2/core.hpp"

namespace cv::iib {

//! Empties what was not found; what has a fixed size, such as a Matx, becomes NaN.
inline void clear(OutputArray output)
{
    if (output.fixedSize())
        output.setTo(Scalar::all(std::numeric_limits<double>::quiet_NaN()));
    else
        output.release();
}

}  // namespace cv::iib
