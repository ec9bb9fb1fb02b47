// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace cv::iib {

/** The real roots of a polynomial of degree 1 to 10, except those of even multiplicity.
@param coefficients degree + 1 numbers, the constant first
@param roots receives up to `degree` numbers
@returns the number of roots */
int realRoots(const double* coefficients, int degree, double* roots);

}  // namespace cv::iib
