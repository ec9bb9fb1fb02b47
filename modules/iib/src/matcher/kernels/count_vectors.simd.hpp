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

/* Each primitive is chosen by instruction set, never by the width of vectors, which different architectures share; where
 there is no portable form, a macro says whether it exists. */

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

//! Of two arrays of words.
inline int countDifferences(const unsigned* a, const unsigned* b, int words)
{
    int count = words % 2 ? countBits(a[words - 1] ^ b[words - 1]) : 0;
    for (int i = 0; i + 1 < words; i += 2)
    {
        uint64 x, y;
        memcpy(&x, a + i, sizeof(x));
        memcpy(&y, b + i, sizeof(y));
        count += countBits(x ^ y);
    }
    return count;
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

// lookUp16 picks bytes out of tables of 16, a table for each 16 bytes of the vector; an index is 0 to 15.
#if CV_AVX512_SKX && IIB_NATIVE_VECTORS
#define IIB_LOOKS_UP_16 1
inline v_uint8 lookUp16(const v_uint8& table, const v_uint8& index)
{
    return v_uint8(_mm512_shuffle_epi8(table.val, index.val));
}
#elif CV_AVX2 && IIB_NATIVE_VECTORS
#define IIB_LOOKS_UP_16 1
inline v_uint8 lookUp16(const v_uint8& table, const v_uint8& index)
{
    return v_uint8(_mm256_shuffle_epi8(table.val, index.val));
}
#elif CV_SSSE3 && IIB_NATIVE_VECTORS
#define IIB_LOOKS_UP_16 1
inline v_uint8 lookUp16(const v_uint8& table, const v_uint8& index)
{
    return v_uint8(_mm_shuffle_epi8(table.val, index.val));
}
#elif CV_NEON && defined __aarch64__ && IIB_NATIVE_VECTORS
#define IIB_LOOKS_UP_16 1
inline v_uint8 lookUp16(const v_uint8& table, const v_uint8& index)
{
    return v_uint8(vqtbl1q_u8(table.val, index.val));
}
#else
#define IIB_LOOKS_UP_16 0
#endif

// Moves the chosen lanes to the front of a vector.
#if CV_AVX512_SKX && IIB_NATIVE_VECTORS
#define IIB_COMPRESSES_LANES 1
inline v_int32 compressLanes(const v_int32& values, int lanes)
{
    return v_int32(_mm512_maskz_compress_epi32((__mmask16)lanes, values.val));
}
#else
#define IIB_COMPRESSES_LANES 0
#endif

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
