// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#pragma once

#include "../../common/vectors.simd.hpp"
#include "kernels.hpp"

namespace cv {
namespace iib {

CV_CPU_OPTIMIZATION_NAMESPACE_BEGIN

namespace {

//! Packed at the low end. @param comparisons readable up to Group::SIZE bytes behind the group's first.
inline unsigned bitsOf(const ChosenBits::Group& group, const uchar* comparisons)
{
    const uchar* const bytes = comparisons + group.byte;
#if CV_SSSE3 || (CV_NEON && defined __aarch64__)
    const v_uint8x16 masks = v_load(group.masks);
#if CV_SSSE3
    const v_uint8x16 found(_mm_shuffle_epi8(v_load(bytes).val, v_load(group.places).val));
#else
    const v_uint8x16 found(vqtbl1q_u8(v_load(bytes).val, v_load(group.places).val));
#endif
    return (unsigned)v_signmask((found & masks) == masks);
#else
    unsigned bits = 0;
    for (int i = 0; i < group.count; i++)
        bits |= (unsigned)((bytes[group.places[i]] & group.masks[i]) != 0) << i;
    return bits;
#endif
}

//! Appends the chosen bits of a phase.
inline void appendChosen(const ChosenBits& chosen, const uchar* comparisons, BitAppender& out)
{
#if CV_AVX512_SKX  // GCC 12 leaves upper halves in use; code without AVX that follows, also a user's, runs at half the speed
    _mm256_zeroupper();
#endif
    BitAppender writer = out;  // a copy, which stores to uchar* surely do not change
    for (const ChosenBits::Group& group : chosen.groups())
        writer.append(bitsOf(group, comparisons), group.count);
    out = writer;
}

}  // namespace

CV_CPU_OPTIMIZATION_NAMESPACE_END

}  // namespace iib
}  // namespace cv
