// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "../../precomp.hpp"

#include "rotated_samples.simd.hpp"
#include "descriptor/kernels/rotated_samples.simd_declarations.hpp"

namespace cv {
namespace iib {

const RotatedSampleKernels<short>& shortRotatedSampleKernels()
{
    CV_CPU_DISPATCH(shortRotatedSampleKernels, (), CV_CPU_DISPATCH_MODES_ALL);
}

const RotatedSampleKernels<int>& intRotatedSampleKernels()
{
    CV_CPU_DISPATCH(intRotatedSampleKernels, (), CV_CPU_DISPATCH_MODES_ALL);
}

}  // namespace iib
}  // namespace cv
