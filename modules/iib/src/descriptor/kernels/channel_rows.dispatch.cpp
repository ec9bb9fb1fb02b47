// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "../../precomp.hpp"

#include "channel_rows.simd.hpp"
#include "descriptor/kernels/channel_rows.simd_declarations.hpp"

namespace cv {
namespace iib {

const RowKernels<short>& shortRowKernels()
{
    CV_CPU_DISPATCH(shortRowKernels, (), CV_CPU_DISPATCH_MODES_ALL);
}

const RowKernels<int>& intRowKernels() { CV_CPU_DISPATCH(intRowKernels, (), CV_CPU_DISPATCH_MODES_ALL); }

}  // namespace iib
}  // namespace cv
