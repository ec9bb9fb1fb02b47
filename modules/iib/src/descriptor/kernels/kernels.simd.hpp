// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// The one dispatched file of the descriptor: the chapters below are compiled with it for each instruction set.

#include "kernels.hpp"

#ifndef CV_CPU_OPTIMIZATION_DECLARATIONS_ONLY
#include "boxes.simd.hpp"
#include "columns.simd.hpp"
#include "rotated_samples.simd.hpp"
#endif

namespace cv {
namespace iib {

CV_CPU_OPTIMIZATION_NAMESPACE_BEGIN

const DescriptorKernels& descriptorKernels();

#ifndef CV_CPU_OPTIMIZATION_DECLARATIONS_ONLY

namespace {

DescriptorKernels makeTable()
{
    DescriptorKernels k;
    k.instructionSet = IIB_INSTRUCTION_SET;
    k.shortPixels.rows = rowKernels<short>();
    k.shortPixels.rotated = rotatedSampleKernels<short>();
    k.intPixels.rows = rowKernels<int>();
    k.intPixels.rotated = rotatedSampleKernels<int>();
    k.sumShortRow = sumRow16;
    k.sumLongRow = sumRow32;
    k.sumIntRow = sumRowOf16Bit;
    k.cellEdges = cellEdges;
    k.shortCells = cellSums<ushort>;
    k.longCells = cellSums<unsigned>;
    k.columnCells = columnCells;
    k.shortBits = bitsKernels<ushort>();
    k.longBits = bitsKernels<unsigned>();
    k.doubleBits = bitsKernels<double>();
    k.boxes = boxKernels();
    return k;
}

}  // namespace

const DescriptorKernels& descriptorKernels()
{
    static const DescriptorKernels table = makeTable();
    return table;
}

#endif

CV_CPU_OPTIMIZATION_NAMESPACE_END

}  // namespace iib
}  // namespace cv
