// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "../../common/vectors.simd.hpp"

#include "kernels.hpp"

namespace cv {
namespace iib {

CV_CPU_OPTIMIZATION_NAMESPACE_BEGIN

const DetectorKernels& detectorKernels();

#ifndef CV_CPU_OPTIMIZATION_DECLARATIONS_ONLY

namespace {

constexpr int SHORTS = VTraits<v_int16>::max_nlanes, INTS = VTraits<v_int32>::max_nlanes;

/* Local normalization. */

void widen(const uchar* pixels, short* out, int width)
{
    int x = 0;
    for (; x <= width - SHORTS; x += SHORTS)
        v_store(out + x, v_reinterpret_as_s16(vx_load_expand(pixels + x)) << GREY_BITS);
    for (; x < width; x++)
        out[x] = (short)(pixels[x] << GREY_BITS);
}

//! The sums of neighbours in two rows.
inline v_int32 sumOfFour(const short* upper, const short* lower)
{
    const v_int16 one = vx_setall_s16(1);
    return v_dotprod(vx_load(upper), one) + v_dotprod(vx_load(lower), one);
}

inline v_int32 quarter(const v_int32& sum) { return (sum + vx_setall_s32(2)) >> 2; }

void halveShorts(const short* upper, const short* lower, short* half, int halfWidth)
{
    for (int x = 0; x < halfWidth; x += SHORTS)
    {
        const v_int32 left = sumOfFour(upper + 2 * x, lower + 2 * x);
        const v_int32 right = sumOfFour(upper + 2 * x + SHORTS, lower + 2 * x + SHORTS);
        v_store(half + x, v_pack(quarter(left), quarter(right)));
    }
}

void halveInts(const int* upper, const int* lower, int* half, int halfWidth)
{
    for (int x = 0; x < halfWidth; x += INTS)
    {
        v_int32 a, b, c, d;
        v_load_deinterleave(upper + 2 * x, a, b);
        v_load_deinterleave(lower + 2 * x, c, d);
        v_store(half + x, quarter((a + b) + (c + d)));
    }
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

void squares(const short* upper, const short* lower, int* half, int halfWidth)
{
    for (int x = 0; x < halfWidth; x += INTS)
    {
        const v_int16 a = eighths(upper + 2 * x), b = eighths(lower + 2 * x);
        v_store(half + x, quarter(v_dotprod(a, a) + v_dotprod(b, b)));
    }
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

/* Blobs. */

void centre(const uchar* pixels, short* out, int width)
{
    int x = 0;
    for (; x <= width - SHORTS; x += SHORTS)
    {
        const v_int16 pixel = v_reinterpret_as_s16(vx_load_expand(pixels + x));
        v_store(out + x, v_max(pixel - vx_setall_s16(128), vx_setall_s16(-127)) << CONTRAST_BITS);
    }
    for (; x < width; x++)
        out[x] = (short)(std::max(pixels[x] - 128, -127) * (1 << CONTRAST_BITS));
}

void smooth(const short* const rows[5], SmoothingWeights weights, short* out, int width)
{
    const v_int16 near = vx_setall_s16(weights.near), far = vx_setall_s16(weights.far);
    for (int x = 0; x < width; x += SHORTS)
    {
        const v_int16 c = vx_load(rows[2] + x), twice = c + c;
        const v_int16 nearer = vx_load(rows[1] + x) + vx_load(rows[3] + x) - twice;
        const v_int16 farther = vx_load(rows[0] + x) + vx_load(rows[4] + x) - twice;
        v_store(out + x, c + v_mul_hi(nearer, near) + v_mul_hi(farther, far));
    }
}

inline v_float32 determinant(const v_int32& xx, const v_int32& yy, const v_int32& xy)
{
    const v_float32 x = v_cvt_f32(xx), y = v_cvt_f32(yy), mixed = v_cvt_f32(xy);
    return x * y - mixed * mixed * vx_setall_f32(1.f / 16);
}

void response(const short* const rows[3], int distance, float factor, float* out, int width)
{
    const v_float32 scale = vx_setall_f32(factor);
    const short *above = rows[0], *row = rows[1], *below = rows[2];
    for (int x = 0; x < width; x += SHORTS)
    {
        const int l = x - distance, r = x + distance;
        const v_int16 c = vx_load(row + x), twice = c + c;
        const v_int16 xx = vx_load(row + l) + vx_load(row + r) - twice;
        const v_int16 yy = vx_load(above + x) + vx_load(below + x) - twice;
        const v_int16 xy =
                (vx_load(above + l) + vx_load(below + r)) - (vx_load(above + r) + vx_load(below + l));
        v_int32 xx0, xx1, yy0, yy1, xy0, xy1;
        v_expand(xx, xx0, xx1);
        v_expand(yy, yy0, yy1);
        v_expand(xy, xy0, xy1);
        v_store(out + x, determinant(xx0, yy0, xy0) * scale);
        v_store(out + x + INTS, determinant(xx1, yy1, xy1) * scale);
    }
}

inline v_float32 largestOfColumn(const float* const rows[3], int x)
{
    return v_max(v_max(vx_load(rows[0] + x), vx_load(rows[1] + x)), vx_load(rows[2] + x));
}

void largest(const float* const rows[3], float* out, int width)
{
    for (int x = 0; x < width; x += INTS)
        v_store(out + x, v_max(v_max(largestOfColumn(rows, x - 1), largestOfColumn(rows, x)),
                                 largestOfColumn(rows, x + 1)));
}

//! The bits of floats, which as integers have the same order where the larger one is positive.
inline v_int32 bits(const float* values) { return v_reinterpret_as_s32(vx_load(values)); }

int maxima(
        const float* values, const float* const bounds[3], float threshold, int begin, int end, int* columns)
{
    int n = 0;
    const v_int32 least = v_reinterpret_as_s32(vx_setall_f32(threshold));
    for (int x = 0; x < end; x += INTS)
    {
        const v_int32 v = bits(values + x);
        const v_int32 bound =
                v_max(v_max(bits(bounds[0] + x), least), v_max(bits(bounds[1] + x), bits(bounds[2] + x)));
        for (unsigned found = greaterEqualMask(v, bound); found; found &= found - 1)
        {
            const int column = x + (int)trailingZeros32(found);
            if (column >= begin && column < end)
                columns[n++] = column;
        }
    }
    return n;
}

}  // namespace

const DetectorKernels& detectorKernels()
{
    static const DetectorKernels kernels = {widen, halveShorts, halveInts, interpolate, upsample, blur,
            subtract, squares, gain, scale, centre, smooth, response, largest, maxima};
    return kernels;
}

#endif

CV_CPU_OPTIMIZATION_NAMESPACE_END

}  // namespace iib
}  // namespace cv
