// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "../../precomp.hpp"

#include "integral.simd.hpp"
#include "descriptor/kernels/integral.simd_declarations.hpp"

namespace cv {
namespace iib {

SumRowFunc<short, ushort>::Type getSumRowFunc(short lane, ushort sum)
{
    CV_CPU_DISPATCH(getSumRowFunc, (lane, sum), CV_CPU_DISPATCH_MODES_ALL);
}

SumRowFunc<short, unsigned>::Type getSumRowFunc(short lane, unsigned sum)
{
    CV_CPU_DISPATCH(getSumRowFunc, (lane, sum), CV_CPU_DISPATCH_MODES_ALL);
}

SumRowFunc<int, unsigned>::Type getSumRowFunc(int lane, unsigned sum)
{
    CV_CPU_DISPATCH(getSumRowFunc, (lane, sum), CV_CPU_DISPATCH_MODES_ALL);
}

size_t integralRowBytes(int width, size_t bytesPerSum)
{
    const size_t bytes = ((size_t)width + 1 + ROW_PADDING) * GROUP_CHANNELS * bytesPerSum;
    // An odd number of cache lines: with an even one the corners of a column would share few cache sets.
    return ((bytes + 63) / 64 | 1) * 64;
}

}  // namespace iib
}  // namespace cv
