// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>

#include "opencv2/core.hpp"

namespace nb = nanobind;

namespace iib_python {

//! What crosses the border: memory of the caller, C-contiguous and native (opencv_iib/_arrays.py sees to that).
typedef nb::ndarray<nb::ro, nb::c_contig, nb::device::cpu> Array;

//! A view of an array of 2 (one channel) or 3 dimensions (channels last). It is empty if the array is, of any dimensions.
//! @throws cv::Exception that names `what` for another number of dimensions or a type that a Mat has not.
cv::Mat viewOf(const Array& array, const char* what);

//! A numpy array that owns the matrix's memory. The matrix has one channel and is continuous.
nb::object toNumpy(const cv::Mat& matrix);

}  // namespace iib_python
