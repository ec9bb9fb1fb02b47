// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "kernels.simd.hpp"
#include "normalization/kernels/kernels.simd_declarations.hpp"

namespace cv { namespace iib {

const FilterKernels& filterKernels() { CV_CPU_DISPATCH(filterKernels, (), CV_CPU_DISPATCH_MODES_ALL); }

}}  // namespace cv::iib
