// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#pragma once

// Cells whose sums 16 bits are too small for, those of 16-bit images too: rows of integral images of 32 bits, and vectors
// of doubles in place of v_int32 where sums or products of 32 bits are too small.

#include "rows.simd.hpp"

namespace cv {

CV_CPU_OPTIMIZATION_HAL_NAMESPACE_BEGIN

/* Doubles, or one of them where there are no such vectors (ARMv7, WebAssembly). */
#if CV_SIMD_64F
typedef v_float64 v_doubles;

inline v_doubles loadDoubles(const double* p) { return vx_load(p); }
inline v_doubles repeatedDouble(double v) { return vx_setall_f64(v); }
#else
typedef double v_doubles;

template <> struct VTraits<double>
{
    static constexpr int max_nlanes = 1;
};
inline double loadDoubles(const double* p) { return *p; }
inline double repeatedDouble(double v) { return v; }
inline void v_store(double* p, double v) { *p = v; }
inline double v_min(double a, double b) { return std::min(a, b); }
inline double v_max(double a, double b) { return std::max(a, b); }
#endif

CV_CPU_OPTIMIZATION_HAL_NAMESPACE_END

namespace iib {

CV_CPU_OPTIMIZATION_NAMESPACE_BEGIN

namespace {

inline v_doubles loadCells(const double* p) { return loadDoubles(p); }
inline v_doubles repeated(int v, const v_doubles&) { return repeatedDouble(v); }

inline void storeAlternately(double* even, double* odd, int lane, const v_doubles& v)
{
#if CV_AVX512_SKX
    v_store_low(even + lane / 2, v);
    v_store_high(odd + lane / 2, v);
#else
    v_store((lane % 8 < 4 ? even : odd) + lane / 8 * 4 + lane % 4, v);
#endif
}

inline v_uint32 repeatLastFour(const v_uint32& v)
{
#if CV_AVX512_SKX
    return v_uint32(_mm512_shuffle_i32x4(v.val, v.val, 0xff));
#elif CV_AVX2
    return v_uint32(_mm256_permute2x128_si256(v.val, v.val, 0x11));
#else
    return v;
#endif
}

void sumRow32(const short* const planes[GROUP_CHANNELS], int width, const unsigned* above, unsigned* out)
{
    const int step = VTraits<v_uint16>::max_nlanes, pixelsInVector = step / GROUP_CHANNELS / 2;
    v_uint32 carry = vx_setzero_u32();
    for (int x = 0; x < width; x += step)
    {
        v_uint16 pixels[4];
        interleave(planes, x, pixels);
        for (int i = 0; i < 8; i += 2)
        {
            v_uint32 sums[2];
            v_expand(pixels[i / 2], sums[0], sums[1]);
            for (int j = 0; j < 2; j++)
            {
                const int at = (x + (i + j) * pixelsInVector + 1) * GROUP_CHANNELS;
                v_store(out + at, sums[j] + carry + vx_load(above + at));
                if ((i + j + 1) * pixelsInVector % 4 == 0)
                    carry = carry + repeatLastFour(sums[j]);
            }
        }
    }
}

//! Of 16-bit images, whose sums over four pixels exceed 16 bits. A pixel is one 128-bit vector here, on every machine.
void sumRowOf16Bit(const int* const planes[GROUP_CHANNELS], int width, const unsigned* above, unsigned* out)
{
    v_uint32x4 sum = v_setzero_u32();
    for (int x = 0; x < width; x++)
    {
        sum = sum + v_uint32x4((unsigned)planes[0][x], (unsigned)planes[1][x], (unsigned)planes[2][x],
                            (unsigned)planes[3][x]);
        v_store(out + 4 * (x + 1), sum + v_load(above + 4 * (x + 1)));
    }
}

}  // namespace

CV_CPU_OPTIMIZATION_NAMESPACE_END

}  // namespace iib
}  // namespace cv
