// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#pragma once

#include "../../precomp.hpp"

namespace cv { namespace iib {

/* Orientation is an integer, so that sums and decisions are exact: ORIENTATION_STEPS a turn, about the
 range of |gx| of 8-bit images. */
constexpr int ORIENTATION_STEPS = 1024;

/* Minimax polynomial a t + b t^3 + c t^5 of ORIENTATION_STEPS / (2 pi) * atan(t) on [0, 1]; its error is
 0.1 step (0.035 degrees). Scalar and vector code evaluate it in the same order without fused operations,
 so both round alike. Found by iteratively reweighted least squares on 20001 points. */
static const float ATAN_A = 162.218109f;
static const float ATAN_B = -47.0491257f;
static const float ATAN_C = 12.9301834f;

}}  // namespace cv::iib
