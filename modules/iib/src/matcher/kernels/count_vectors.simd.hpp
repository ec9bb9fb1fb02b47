// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// Vectors of one value for each code of a CodeBlock, which all kernels of the matcher share.

#ifndef OPENCV_IIB_MATCHER_KERNELS_COUNT_VECTORS_SIMD_HPP
#define OPENCV_IIB_MATCHER_KERNELS_COUNT_VECTORS_SIMD_HPP

#include "../../common/simd.hpp"
#include "code_layout.hpp"

namespace cv {
namespace iib {
CV_CPU_OPTIMIZATION_NAMESPACE_BEGIN
namespace {

typedef v_uint32 Words;
typedef v_int32 Counts;
const int CODES_PER_BLOCK = CodeLayout::CODES_PER_BLOCK, WIDTH = VTraits<Words>::max_nlanes,
          VECTORS = CODES_PER_BLOCK / WIDTH, ALL_LANES = (1 << CODES_PER_BLOCK) - 1;

//! 0, 1, 2, ... over the lanes of a vector.
inline Counts laneNumbers()
{
    static const int NUMBERS[CODES_PER_BLOCK] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15};
    return vx_load(NUMBERS);
}

//! The lanes with a negative value.
CV_ALWAYS_INLINE int negativeLanes(const Counts* values)
{
    int lanes = 0;
    for (int v = 0; v < VECTORS; v++)
        lanes |= v_signmask(values[v]) << v * WIDTH;
    return lanes;
}

//! Writes the values of some lanes, and may write CODES_PER_BLOCK values whatever their number.
CV_ALWAYS_INLINE void storeLanes(int* to, const Counts* values, int lanes)
{
#if IIB_COMPRESSES_LANES
    for (int v = 0; v < VECTORS; v++, lanes >>= WIDTH)
    {
        v_store(to, compressLanes(values[v], lanes));
        to += countBits((unsigned)lanes & ((1u << WIDTH) - 1));
    }
#else
    int all[CODES_PER_BLOCK];
    for (int v = 0; v < VECTORS; v++)
        v_store(all + v * WIDTH, values[v]);
    for (; lanes; lanes &= lanes - 1)
        *to++ = all[trailingZeros32(lanes)];
#endif
}

}  // namespace
CV_CPU_OPTIMIZATION_NAMESPACE_END
}  // namespace iib
}  // namespace cv

#endif
