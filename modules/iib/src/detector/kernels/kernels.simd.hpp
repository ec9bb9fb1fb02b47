// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "kernels.hpp"

namespace cv {
namespace iib {
CV_CPU_OPTIMIZATION_NAMESPACE_BEGIN
const DetectorKernels& detectorKernels();
CV_CPU_OPTIMIZATION_NAMESPACE_END
}  // namespace iib
}  // namespace cv

#ifndef CV_CPU_OPTIMIZATION_DECLARATIONS_ONLY

#include "../../common/vectors.simd.hpp"

namespace cv {
namespace iib {

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

void smooth(const short* const rows[5], SmoothingWeights weights, short* out, int width)
{
    const v_int16 near = vx_setall_s16(weights.near), far = vx_setall_s16(weights.far);
    // copies: compilers think that stores of vectors change what `rows` holds
    const short *const a = rows[0], *const b = rows[1], *const m = rows[2], *const d = rows[3],
                       *const e = rows[4];
    for (int x = 0; x < width; x += SHORTS)
    {
        const v_int16 c = vx_load(m + x), twice = plus(c, c);
        const v_int16 nearer = minus(plus(vx_load(b + x), vx_load(d + x)), twice);
        const v_int16 farther = minus(plus(vx_load(a + x), vx_load(e + x)), twice);
        v_store(out + x, plus(c, plus(v_mul_hi(nearer, near), v_mul_hi(farther, far))));
    }
}

void response(const short* const rows[3], int distance, float factor, float* out, int width)
{
    const v_float32 scale = vx_setall_f32(factor);
    const short *above = rows[0], *row = rows[1], *below = rows[2];
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
        v_store(out + x, v_cvt_f32(v_dotprod(first0, second0)) * scale);
        v_store(out + x + INTS, v_cvt_f32(v_dotprod(first1, second1)) * scale);
    }
}

void largest(const float* const rows[3], float* out, int width)
{
    const float *const above = rows[0], *const row = rows[1], *const below = rows[2];
    const auto ofColumn = [&](int x) {
        return v_max(v_max(vx_load(above + x), vx_load(row + x)), vx_load(below + x));
    };
    v_float32 before = ofColumn(-INTS), columns = ofColumn(0);
    for (int x = 0; x < width; x += INTS)
    {
        const v_float32 after = ofColumn(x + INTS);
        const v_float32 left = v_extract<INTS - 1>(before, columns), right = v_extract<1>(columns, after);
        v_store(out + x, v_max(v_max(left, columns), right));
        before = columns;
        columns = after;
    }
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
    static const DetectorKernels kernels = {centre, smooth, response, largest, maxima};
    return kernels;
}

CV_CPU_OPTIMIZATION_NAMESPACE_END

}  // namespace iib
}  // namespace cv

#endif
