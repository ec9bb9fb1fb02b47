// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "../../precomp.hpp"

#include "cells.simd.hpp"
#include "descriptor/kernels/cells.simd_declarations.hpp"

namespace cv {
namespace iib {

CellEdgesFunc getCellEdgesFunc() { CV_CPU_DISPATCH(getCellEdgesFunc, (), CV_CPU_DISPATCH_MODES_ALL); }

CellSumsFunc<ushort>::Type getCellSumsFunc(ushort sum)
{
    CV_CPU_DISPATCH(getCellSumsFunc, (sum), CV_CPU_DISPATCH_MODES_ALL);
}

CellSumsFunc<unsigned>::Type getCellSumsFunc(unsigned sum)
{
    CV_CPU_DISPATCH(getCellSumsFunc, (sum), CV_CPU_DISPATCH_MODES_ALL);
}

}  // namespace iib
}  // namespace cv
