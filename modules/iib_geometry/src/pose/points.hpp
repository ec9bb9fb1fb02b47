// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "opencv2/core.hpp"

namespace cv::iib {

/** Points that a caller gave, N x 2, CV_64F.
@throws cv::Exception that names the function and the argument, for what are no points. */
Mat pointsOf(InputArray given, const char* function, const char* argument);

//! @throws cv::Exception for different numbers of points.
void checkMatched(const Mat& points1, const Mat& points2, const char* function);

/** What points span, N x 2, CV_64F, without the outermost fiftieth on each side: one wrong match may be far away. At least one pixel
wide and high. */
Rect2d spanOf(const Mat& points);

//! Empties what was not found; what has a fixed size, such as a Matx, becomes NaN.
void clear(OutputArray output);

}  // namespace cv::iib
