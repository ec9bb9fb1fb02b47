// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "hamming.simd.hpp"
#include "matcher/kernels/hamming.simd_declarations.hpp"

namespace cv { namespace iib {

const HammingKernels& hammingKernels() { CV_CPU_DISPATCH(hammingKernels, (), CV_CPU_DISPATCH_MODES_ALL); }

}}  // namespace cv::iib
