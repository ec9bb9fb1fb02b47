// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "kernels.hpp"

namespace cv { namespace iib {
CV_CPU_OPTIMIZATION_NAMESPACE_BEGIN
const FilterKernels& filterKernels();
CV_CPU_OPTIMIZATION_NAMESPACE_END
}}  // namespace cv::iib

#ifndef CV_CPU_OPTIMIZATION_DECLARATIONS_ONLY

#include "../../common/vectors.simd.hpp"

namespace cv { namespace iib {
CV_CPU_OPTIMIZATION_NAMESPACE_BEGIN
namespace {

// At -O3 compilers make vectors of this loop and that of blur(), with this file's instruction set.
void widen(const uchar* pixels, short* out, int width)
{
    for (int x = 0; x < width; x++)
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

// Sums of four contrasts, and rounding, fit 16 bits: adding without saturation is cheaper on some machines.
inline v_int16 plus(const v_int16& a, const v_int16& b) { return v_add_wrap(a, b); }
inline v_int16 minus(const v_int16& a, const v_int16& b) { return v_sub_wrap(a, b); }

//! Repeats the ends of a row, at least this many times.
void repeatEnds(short* row, int width, int times)
{
    const v_int16 first = vx_setall_s16(row[0]), last = vx_setall_s16(row[width - 1]);
    for (int i = 0; i < times; i += SHORTS)
    {
        v_store(row - i - SHORTS, first);
        v_store(row + width + i, last);
    }
}

inline void smoothRow(const short* a, const short* b, const short* m, const short* d, const short* e,
        const SmoothingStep& step, short* out, int width)
{
    const v_int16 near = vx_setall_s16(step.near), far = vx_setall_s16(step.far);
    for (int x = 0; x < width; x += SHORTS)
    {
        const v_int16 c = vx_load(m + x), twice = plus(c, c);
        const v_int16 nearer = minus(plus(vx_load(b + x), vx_load(d + x)), twice);
        const v_int16 farther = minus(plus(vx_load(a + x), vx_load(e + x)), twice);
        v_store(out + x, plus(c, plus(v_mul_hi(nearer, near), v_mul_hi(farther, far))));
    }
}

void smooth(const short* const rows[5], const SmoothingStep& step, short* between, short* out, int width)
{
    const int s = step.spacing;
    smoothRow(rows[0], rows[1], rows[2], rows[3], rows[4], step, between, width);
    repeatEnds(between, width, 2 * s);
    smoothRow(between - 2 * s, between - s, between, between + s, between + 2 * s, step, out, width);
    repeatEnds(out, width, step.distance);
}

void response(const short* const rows[3], int distance, float factor, const ResponseRows& out, int width)
{
    const v_float32 scale = vx_setall_f32(factor);
    const short *above = rows[0], *row = rows[1], *below = rows[2], *before = out.before,
                *beforeThat = out.beforeThat;
    float* const values = out.values;
    short *const upper = out.upper, *const largest = out.largest;
    for (int x = 0; x < width; x += SHORTS)
    {
        const int l = x - distance, r = x + distance;
        const v_int16 c = vx_load(row + x), twice = plus(c, c);
        const v_int16 xx = minus(plus(vx_load(row + l), vx_load(row + r)), twice);
        const v_int16 yy = minus(plus(vx_load(above + x), vx_load(below + x)), twice);
        const v_int16 xy = minus(
                plus(vx_load(above + l), vx_load(below + r)), plus(vx_load(above + r), vx_load(below + l)));
        const v_int16 mixed = plus(xy, vx_setall_s16(2)) >> 2;
        v_int16 first0, first1, second0, second1;
        v_zip(xx, mixed, first0, first1);
        v_zip(yy, vx_setzero_s16() - mixed, second0, second1);
        const v_float32 low = v_cvt_f32(v_dotprod(first0, second0)) * scale;
        const v_float32 high = v_cvt_f32(v_dotprod(first1, second1)) * scale;
        v_store(values + x, low);
        v_store(values + x + INTS, high);
        const v_int16 halves = v_pack(v_reinterpret_as_s32(low) >> 16, v_reinterpret_as_s32(high) >> 16);
        v_store(upper + x, halves);
        v_store(largest + x, v_max(v_max(vx_load(before + x), vx_load(beforeThat + x)), halves));
    }
}

//! The lanes of two vectors, one behind the other, from lane N on. Of bytes, this is one instruction everywhere.
template <int N> inline v_int16 lanesFrom(const v_int16& first, const v_int16& second)
{
    return v_reinterpret_as_s16(
            v_extract<N*(int)sizeof(short)>(v_reinterpret_as_u8(first), v_reinterpret_as_u8(second)));
}

int maxima(
        const short* values, const short* const largest[3], short threshold, int begin, int end, int* columns)
{
    const int TOGETHER = 32;  // columns per branch
    const short *const smaller = largest[0], *const same = largest[1], *const larger = largest[2];
    const auto ofColumn = [&](int x) {
        return v_max(v_max(vx_load(smaller + x), vx_load(same + x)), vx_load(larger + x));
    };
    int n = 0;
    const v_int16 least = vx_setall_s16(threshold);
    v_int16 before = ofColumn(-SHORTS), column = ofColumn(0);
    for (int from = 0; from < end; from += TOGETHER)
    {
        unsigned exceeded = 0;
        for (int i = 0; i < TOGETHER; i += SHORTS)
        {
            const v_int16 after = ofColumn(from + i + SHORTS);
            const v_int16 bound = v_max(v_max(lanesFrom<SHORTS - 1>(before, column), v_max(column, least)),
                    lanesFrom<1>(column, after));
            exceeded |= greaterMask(bound, vx_load(values + from + i)) << i;
            before = column;
            column = after;
        }
        for (unsigned found = ~exceeded; found; found &= found - 1)
        {
            const int x = from + (int)trailingZeros32(found);
            if (x >= begin && x < end)
                columns[n++] = x;
        }
    }
    return n;
}

}  // namespace

const FilterKernels& filterKernels()
{
    static const FilterKernels kernels = {widen, halveShorts, halveInts, interpolate, upsample, blur,
            subtract, halveSquares, gain, scale, centre, smooth, response, maxima};
    return kernels;
}

CV_CPU_OPTIMIZATION_NAMESPACE_END
}}  // namespace cv::iib

#endif
