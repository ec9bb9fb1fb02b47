// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "opencv2/core.hpp"

namespace cv::iib {

/** The essential matrices, up to ten, that fit five matches (Nister 2004).
@param first, second directions in the two cameras, third coordinate 1
@param essentials cleared, then filled */
void fivePointEssentials(const Point2d first[5], const Point2d second[5], std::vector<Matx33d>& essentials);

/** The real roots of a polynomial of degree 1 to 10, except those of even multiplicity (real_roots.cpp).
@param coefficients degree + 1 numbers, the constant first
@param roots receives up to `degree` numbers
@returns the number of roots */
int realRoots(const double* coefficients, int degree, double* roots);

}  // namespace cv::iib
