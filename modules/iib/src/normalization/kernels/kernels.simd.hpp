// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "kernels.hpp"

namespace cv { namespace iib {
CV_CPU_OPTIMIZATION_NAMESPACE_BEGIN
const NormalizationKernels& normalizationKernels();
CV_CPU_OPTIMIZATION_NAMESPACE_END
}}  // namespace cv::iib

#ifndef CV_CPU_OPTIMIZATION_DECLARATIONS_ONLY

#include "../../common/vectors.simd.hpp"

namespace cv { namespace iib {
CV_CPU_OPTIMIZATION_NAMESPACE_BEGIN
namespace {

void widen(const uchar* pixels, short* out, int width)
{
    int x = 0;
    for (; x <= width - SHORTS; x += SHORTS)
        v_store(out + x, v_reinterpret_as_s16(vx_load_expand(pixels + x)) << GREY_BITS);
    for (; x < width; x++)
        out[x] = (short)(pixels[x] << GREY_BITS);
}

//! first, second, first, second, ...
inline v_int16 alternating(short first, short second)
{
    v_int16 pairs, more;
    v_zip(vx_setall_s16(first), vx_setall_s16(second), pairs, more);
    return pairs;
}

inline v_int32 tripled(const v_int32& v) { return v + v + v; }

//! The rounded mean of 4 x 4 pixels weighted 1, 3, 3, 1, from weighted sums of the outer and of the inner rows.
inline v_int32 mean(const v_int32& outerRows, const v_int32& innerRows)
{
    return (outerRows + tripled(innerRows) + vx_setall_s32(32)) >> 6;
}

inline v_int32 weightedSum(const short* row)
{
    return v_dotprod(vx_load(row - 1), alternating(1, 3)) + v_dotprod(vx_load(row + 1), alternating(3, 1));
}

inline v_int32 meansOfFourRows(const short* const rows[4], int x)
{
    return mean(weightedSum(rows[0] + x) + weightedSum(rows[3] + x),
            weightedSum(rows[1] + x) + weightedSum(rows[2] + x));
}

void halveShorts(const short* const rows[4], short* half, int halfWidth)
{
    for (int x = 0; x < halfWidth; x += SHORTS)
        v_store(half + x, v_pack(meansOfFourRows(rows, 2 * x), meansOfFourRows(rows, 2 * x + SHORTS)));
}

inline v_int32 weightedSum(const int* row)
{
    v_int32 a, b, c, d;
    v_load_deinterleave(row - 1, a, b);
    v_load_deinterleave(row + 1, c, d);
    return a + d + tripled(b + c);
}

void halveInts(const int* const rows[4], int* half, int halfWidth)
{
    for (int x = 0; x < halfWidth; x += INTS)
        v_store(half + x, mean(weightedSum(rows[0] + 2 * x) + weightedSum(rows[3] + 2 * x),
                                  weightedSum(rows[1] + 2 * x) + weightedSum(rows[2] + 2 * x)));
}

void interpolate(const short* from, const short* to, short* out, int width)
{
    for (int x = 0; x < width; x += SHORTS)
    {
        const v_int16 a = vx_load(from + x), b = vx_load(to + x);
        v_store(out + x, a + ((b - a) >> 2));
    }
}

void upsample(const short* half, short* out, int halfWidth)
{
    for (int x = 0; x < halfWidth; x += SHORTS)
    {
        const v_int16 left = vx_load(half + x - 1), centre = vx_load(half + x), right = vx_load(half + x + 1);
        v_store_interleave(out + 2 * x, centre + ((left - centre) >> 2), centre + ((right - centre) >> 2));
    }
}

// The compiler makes vectors of this loop, with this file's instruction set.
void blur(const int* before, const int* centre, const int* after, int weight, int* out, int width)
{
    for (int x = 0; x < width; x++)
        out[x] = centre[x] + ((weight * (before[x] + after[x] - 2 * centre[x]) + 128) >> 8);
}

void subtract(const short* pixels, const short* means, short* out, int width)
{
    for (int x = 0; x < width; x += SHORTS)
        v_store(out + x, vx_load(pixels + x) - vx_load(means + x));
}

//! In eighths of a grey level, so that the sum of four squares fits 32 bits.
inline v_int16 eighths(const short* differences)
{
    return (vx_load(differences) + vx_setall_s16(1 << (GREY_BITS - 4))) >> (GREY_BITS - 3);
}

inline v_int32 weightedSquares(const short* row)
{
    const v_int16 before = eighths(row - 1), after = eighths(row + 1);
    return v_dotprod(before, v_mul_wrap(before, alternating(1, 3))) +
           v_dotprod(after, v_mul_wrap(after, alternating(3, 1)));
}

void halveSquares(const short* const rows[4], int* half, int halfWidth)
{
    for (int x = 0; x < halfWidth; x += INTS)
        v_store(half + x, mean(weightedSquares(rows[0] + 2 * x) + weightedSquares(rows[3] + 2 * x),
                                  weightedSquares(rows[1] + 2 * x) + weightedSquares(rows[2] + 2 * x)));
}

inline v_int32 gainOf(const int* variance)
{
    const v_float32 deviation = exactRoot(v_cvt_f32(vx_load(variance)));  // in eighths
    return nearestInt(exactQuotient(vx_setall_f32(1024 * 40 * 8), deviation + vx_setall_f32(2 * 8)));
}

void gain(const int* variance, short* out, int width)
{
    for (int x = 0; x < width; x += SHORTS)
        v_store(out + x, v_pack(gainOf(variance + x), gainOf(variance + x + INTS)));
}

//! Half-units of the output; >> 16 takes away the bits of GREY_BITS and all but one of gain's ten.
inline v_int16 scaled(const short* differences, const short* gains)
{
    const v_int16 product = v_mul_hi(vx_load(differences), vx_load(gains));
    return ((product + vx_setall_s16(1)) >> 1) + vx_setall_s16(128);
}

void scale(const short* differences, const short* gains, uchar* pixels, int width)
{
    int x = 0;
    for (; x <= width - 2 * SHORTS; x += 2 * SHORTS)
        v_store(pixels + x, v_pack_u(scaled(differences + x, gains + x),
                                    scaled(differences + x + SHORTS, gains + x + SHORTS)));
    for (; x < width; x++)
        pixels[x] = saturate_cast<uchar>((((differences[x] * gains[x] >> 16) + 1) >> 1) + 128);
}

}  // namespace

const NormalizationKernels& normalizationKernels()
{
    static const NormalizationKernels kernels = {
            widen, halveShorts, halveInts, interpolate, upsample, blur, subtract, halveSquares, gain, scale};
    return kernels;
}

CV_CPU_OPTIMIZATION_NAMESPACE_END
}}  // namespace cv::iib

#endif
