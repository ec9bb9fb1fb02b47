// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "../../precomp.hpp"
#include "hamming.hpp"

#include "hamming.simd.hpp"
#include "matcher/kernels/hamming.simd_declarations.hpp"

namespace cv {
namespace iib {

void hammingScan(const HammingScan& scan) { CV_CPU_DISPATCH(hammingScan, (scan), CV_CPU_DISPATCH_MODES_ALL); }

CodePacking hammingPacking() { CV_CPU_DISPATCH(hammingPacking, (), CV_CPU_DISPATCH_MODES_ALL); }

const char* hammingInstructionSet() { CV_CPU_DISPATCH(hammingInstructionSet, (), CV_CPU_DISPATCH_MODES_ALL); }

}  // namespace iib
}  // namespace cv
