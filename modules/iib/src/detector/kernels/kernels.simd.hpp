// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "kernels.hpp"

namespace cv { namespace iib {
CV_CPU_OPTIMIZATION_NAMESPACE_BEGIN
const DetectorKernels& detectorKernels();
CV_CPU_OPTIMIZATION_NAMESPACE_END
}}  // namespace cv::iib

#ifndef CV_CPU_OPTIMIZATION_DECLARATIONS_ONLY

#include "../../common/vectors.simd.hpp"

namespace cv { namespace iib {
CV_CPU_OPTIMIZATION_NAMESPACE_BEGIN
namespace {

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
        SmoothingWeights weights, short* out, int width)
{
    const v_int16 near = vx_setall_s16(weights.near), far = vx_setall_s16(weights.far);
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
    smoothRow(rows[0], rows[1], rows[2], rows[3], rows[4], step.weights, between, width);
    repeatEnds(between, width, 2 * s);
    smoothRow(between - 2 * s, between - s, between, between + s, between + 2 * s, step.weights, out, width);
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

const DetectorKernels& detectorKernels()
{
    static const DetectorKernels kernels = {centre, smooth, response, maxima};
    return kernels;
}

CV_CPU_OPTIMIZATION_NAMESPACE_END
}}  // namespace cv::iib

#endif
