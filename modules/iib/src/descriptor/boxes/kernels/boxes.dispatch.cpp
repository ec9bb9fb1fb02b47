// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "../../../precomp.hpp"

#include "boxes.simd.hpp"
#include "descriptor/boxes/kernels/boxes.simd_declarations.hpp"

namespace cv {
namespace iib {

const BoxKernels& boxKernels() { CV_CPU_DISPATCH(boxKernels, (), CV_CPU_DISPATCH_MODES_ALL); }

}  // namespace iib
}  // namespace cv
