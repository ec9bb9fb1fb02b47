// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <vector>

#include "opencv2/core.hpp"

namespace cv::iib {

inline double square(double x) { return x * x; }

//! The median; 0 if `values` is empty.
template <typename T> T median(std::vector<T> values)
{
    const auto middle = values.begin() + std::ptrdiff_t(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return values.empty() ? T() : *middle;
}

typedef std::vector<Point2d> Points;

//! @throws cv::Exception that names the function and the argument if the array does not hold points.
Points pointsOf(InputArray given, const char* function, const char* argument);

//! @throws cv::Exception for different numbers of points.
void checkMatched(const Points& points1, const Points& points2, const char* function);

//! The point mapped by a transform.
Point2d moved(const Matx33d& by, const Point2d& point);

/** The bounding box of points without the outermost 2 % on each side: one wrong match may be far away. At least one
pixel wide and high. */
Rect2d spanOf(Points points);

//! Empties an output; one of fixed size, such as a Matx, becomes NaN.
void clear(OutputArray output);

}  // namespace cv::iib
