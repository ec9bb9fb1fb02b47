// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// Vectors of one value for each code of a CodeBlock, which all kernels of the matcher share.

#pragma once

#include "../../common/vectors.simd.hpp"
#include "code_layout.hpp"

namespace cv {
namespace iib {
CV_CPU_OPTIMIZATION_NAMESPACE_BEGIN
namespace {

/* Each primitive is chosen by instruction set, never by the width of vectors, which different architectures share;
 where there is no portable form, a macro says whether it exists. */

//! Number of set bits.
inline int countBits(uint64 word)
{
#if CV_POPCNT && (defined __x86_64__ || defined _M_X64)
    return (int)_mm_popcnt_u64(word);
#else
    word -= word >> 1 & CV_BIG_UINT(0x5555555555555555);
    word = (word & CV_BIG_UINT(0x3333333333333333)) + (word >> 2 & CV_BIG_UINT(0x3333333333333333));
    return (int)(((word + (word >> 4)) & CV_BIG_UINT(0x0f0f0f0f0f0f0f0f)) * CV_BIG_UINT(0x0101010101010101) >>
                 56);
#endif
}

// v_popcount(v_uint32) is one instruction; elsewhere counting bytes is cheaper.
#if CV_AVX512_ICL && IIB_NATIVE_VECTORS
#define IIB_COUNTS_LANES 1
#else
#define IIB_COUNTS_LANES 0
#endif

//! A full adder of parity, `first` and `second`, given by x = parity ^ first and a ^ b = first ^ second: returns the
//! carry and makes parity the low bit of the sum.
inline v_uint32 fullAdder(v_uint32& parity, const v_uint32& x, const v_uint32& a, const v_uint32& b)
{
    const v_uint32 before = parity;
#if CV_AVX512_SKX && IIB_NATIVE_VECTORS
    // The next parity is before ^ a ^ b; it stands for y in the table of the carry.
    parity = v_uint32(_mm512_ternarylogic_epi32(before.val, a.val, b.val, 0x96));
    return v_uint32(_mm512_ternarylogic_epi32(before.val, x.val, parity.val, 0x74));
#else
    const v_uint32 y = a ^ b;
    parity = before ^ y;
    return before ^ (x & ~y);
#endif
}

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

}  // namespace
CV_CPU_OPTIMIZATION_NAMESPACE_END
}  // namespace iib
}  // namespace cv
