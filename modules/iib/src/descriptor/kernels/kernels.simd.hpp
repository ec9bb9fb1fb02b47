// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "boxes.hpp"

namespace cv { namespace iib {
CV_CPU_OPTIMIZATION_NAMESPACE_BEGIN
const DescriptorKernels& descriptorKernels();
const BoxKernels& boxKernels();
CV_CPU_OPTIMIZATION_NAMESPACE_END
}}  // namespace cv::iib

#ifndef CV_CPU_OPTIMIZATION_DECLARATIONS_ONLY

#include "bits.simd.hpp"
#include "boxes.simd.hpp"
#include "cells.simd.hpp"
#include "rotated_samples.simd.hpp"

namespace cv { namespace iib {
CV_CPU_OPTIMIZATION_NAMESPACE_BEGIN

const DescriptorKernels& descriptorKernels()
{
    static const DescriptorKernels table = {IIB_INSTRUCTION_SET,
            {rowKernels<short>(), rotatedSampleKernels<short>()},
            {rowKernels<int>(), rotatedSampleKernels<int>()}, {sumRow16, cellSums<ushort>},
            {sumRow32, cellSums<unsigned>}, {sumRowOf16Bit, cellSums<unsigned>}, columnCells,
            bitsKernels<ushort>(), bitsKernels<unsigned>(), bitsKernels<double>(), cellEdges};
    return table;
}

const BoxKernels& boxKernels()
{
    static const BoxKernels table = {boxSumKernels<short>(), boxSumKernels<int>(), boxEdges, boxPlaces};
    return table;
}

CV_CPU_OPTIMIZATION_NAMESPACE_END
}}  // namespace cv::iib

#endif
