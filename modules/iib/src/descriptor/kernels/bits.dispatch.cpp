// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "../../precomp.hpp"

#include "bits.simd.hpp"
#include "descriptor/kernels/bits.simd_declarations.hpp"

namespace cv {
namespace iib {

BitsKernels<ushort> getBitsKernels(int mapping, ushort cell)
{
    CV_CPU_DISPATCH(getBitsKernels, (mapping, cell), CV_CPU_DISPATCH_MODES_ALL);
}

BitsKernels<unsigned> getBitsKernels(int mapping, unsigned cell)
{
    CV_CPU_DISPATCH(getBitsKernels, (mapping, cell), CV_CPU_DISPATCH_MODES_ALL);
}

}  // namespace iib
}  // namespace cv
