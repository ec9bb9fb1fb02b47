// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "opencv2/core.hpp"

namespace cv::iib {

/** Points that a caller gave, N x 2, CV_64F.
@throws cv::Exception that names the function and the argument, for what are no points. */
Mat pointsOf(InputArray given, const char* function, const char* argument);

//! @throws cv::Exception for different numbers of points.
void checkMatched(const Mat& points1, const Mat& points2, const char* function);

//! Where a transform has a point.
Point2d moved(const Matx33d& by, const Point2d& point);

/** What points span, N x 2, CV_64F, without the outermost fiftieth on each side: one wrong match may be far away. At least one pixel
wide and high. */
Rect2d spanOf(const Mat& points);

/** Writes rows of numbers to a matrix, or to what has a type of its own: other numbers, or elements that are rows each, as those of
std::vector<Point2f>. */
void writeRows(const Mat& rows, OutputArray output);

//! Empties what was not found; what has a fixed size, such as a Matx, becomes NaN.
void clear(OutputArray output);

}  // namespace cv::iib
