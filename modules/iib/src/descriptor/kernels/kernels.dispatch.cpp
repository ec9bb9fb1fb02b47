// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "kernels.simd.hpp"
#include "descriptor/kernels/kernels.simd_declarations.hpp"

namespace cv { namespace iib {

const BoxKernels& boxKernels() { CV_CPU_DISPATCH(boxKernels, (), CV_CPU_DISPATCH_MODES_ALL); }
const DescriptorKernels& descriptorKernels()
{
    CV_CPU_DISPATCH(descriptorKernels, (), CV_CPU_DISPATCH_MODES_ALL);
}

}}  // namespace cv::iib
