// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "kernels.hpp"

namespace cv {
namespace iib {
CV_CPU_OPTIMIZATION_NAMESPACE_BEGIN
const RefinementKernels& refinementKernels();
CV_CPU_OPTIMIZATION_NAMESPACE_END
}  // namespace iib
}  // namespace cv

#ifndef CV_CPU_OPTIMIZATION_DECLARATIONS_ONLY

#include "../../common/vectors.simd.hpp"

namespace cv {
namespace iib {

CV_CPU_OPTIMIZATION_NAMESPACE_BEGIN

namespace {

static_assert(PATCH % INTS == 0 && PATCH_SAMPLES % SHORTS == 0, "vectors fit rows and patches");

void smooth(const uchar* const rows[3], ushort* sums, uchar* out, int width)
{
    int x = 0;
    for (; x <= width - SHORTS; x += SHORTS)
        v_store(sums + 1 + x, vx_load_expand(rows[0] + x) + vx_load_expand(rows[2] + x) +
                                      (vx_load_expand(rows[1] + x) << 1));
    for (; x < width; x++)
        sums[1 + x] = (ushort)(rows[0][x] + 2 * rows[1][x] + rows[2][x]);
    sums[0] = sums[1];
    sums[width + 1] = sums[width];
    for (x = 0; x <= width - SHORTS; x += SHORTS)
        v_pack_store(out + x, (vx_load(sums + x) + vx_load(sums + x + 2) + (vx_load(sums + x + 1) << 1) +
                                      vx_setall_u16(8)) >>
                                      4);
    for (; x < width; x++)
        out[x] = (uchar)((sums[x] + 2 * sums[x + 1] + sums[x + 2] + 8) >> 4);
}

inline void storePixels(int* out, const v_uint16& left, const v_uint16& right)
{
    const v_uint16 signs = vx_setall_u16(0x8080);
    v_uint16 first, second;
    v_zip(left ^ signs, right ^ signs, first, second);
    v_store(out, v_reinterpret_as_s32(first));
    v_store(out + INTS, v_reinterpret_as_s32(second));
}

void readWindow(const uchar* pixels, size_t step, Size size, int* window)
{
    for (int y = 0; y < size.height; y++, pixels += step, window += WINDOW)
        for (int x = 0; x < size.width; x += 2 * SHORTS)
        {
            const uchar* const upper = pixels + x;
            const uchar* const lower = upper + step;
            v_uint8 left[2], right[2];
            v_zip(vx_load(upper), vx_load(lower), left[0], left[1]);
            v_zip(vx_load(upper + 1), vx_load(lower + 1), right[0], right[1]);
            for (int i = 0; i < 2; i++)
                storePixels(window + x + i * SHORTS, v_reinterpret_as_u16(left[i]),
                        v_reinterpret_as_u16(right[i]));
        }
}

//! Weights, in 2^-8, of two neighbours in the halves of each lane: what is left of a position below whole pixels.
inline v_int32 weightsOf(const v_int32& position)
{
    const v_int32 part = (position >> (POSITION_BITS - 8)) & vx_setall_s32(255);
    return (part << 16) + (vx_setall_s32(256) - part);
}

inline v_int32 dotProduct(const v_int16& a, const v_int32& pairs)
{
    return v_dotprod(a, v_reinterpret_as_s16(pairs));
}

inline v_int32 samplesAt(const int* window, const v_int32& x, const v_int32& y)
{
    const v_int32 rows = (y >> (POSITION_BITS - WINDOW_BITS)) & vx_setall_s32(-WINDOW);
    const v_int32 places = rows + (x >> POSITION_BITS);
    const v_int16 four = v_reinterpret_as_s16(v_lut(window, places));
    const v_int32 weightsX = weightsOf(x);
    const v_int32 upper = dotProduct((four << 8) >> 8, weightsX), lower = dotProduct(four >> 8, weightsX);
    const v_int32 both = (upper & vx_setall_s32(0xffff)) | (lower << 16);
    const v_int32 sample = dotProduct(v_reinterpret_as_s16(both), weightsOf(y));
    return (sample + vx_setall_s32(1 << (15 - SAMPLE_BITS))) >> (16 - SAMPLE_BITS);
}

void sample(const int* window, const PatchGrid& grid, short* samples)
{
    int columns[INTS];
    for (int i = 0; i < INTS; i++)
        columns[i] = i;
    const v_int32 column = vx_load(columns);
    const v_int32 x = column * vx_setall_s32(grid.column.x), y = column * vx_setall_s32(grid.column.y);
    const auto from = [&](int i) {
        const Point first = grid.first + i / PATCH * grid.row + i % PATCH * grid.column;
        return samplesAt(window, x + vx_setall_s32(first.x), y + vx_setall_s32(first.y));
    };
    for (int i = 0; i < PATCH_SAMPLES; i += 2 * INTS)
        v_store(samples + i, v_pack(from(i), from(i + INTS)));
}

//! Eight pixels, every second one from the second on, as samples.
inline v_int16x8 everySecond(const uchar* pixels)
{
    return v_reinterpret_as_s16((v_reinterpret_as_u16(v_load(pixels)) >> 8) << SAMPLE_BITS);
}

void readTemplate(const uchar* pixels, size_t step, PatchTemplate& out)
{
    for (int i = 0; i < PATCH_SAMPLES; i += 8)
    {
        const uchar* const p = pixels + (2 * (i / PATCH) + 1) * step + 2 * (i % PATCH);
        v_store(out.samples + i, everySecond(p) - v_setall_s16(128 << SAMPLE_BITS));
        v_store(out.derivatives[0] + i, (everySecond(p + 1) - everySecond(p - 1)) >> 1);
        v_store(out.derivatives[1] + i, (everySecond(p + step) - everySecond(p - step)) >> 1);
    }
}

void makeTemplate(const uchar* pixels, size_t step, const PatchWeights& weights, PatchTemplate& out)
{
    readTemplate(pixels, step, out);
    for (int i = 0; i < PATCH_SAMPLES; i += SHORTS)
    {
        const v_int16 all[] = {vx_load(weights.gaussian + i), vx_load(weights.gaussianX + i),
                vx_load(weights.gaussianY + i)};
        v_store(out.weights[0] + i, v_mul_hi(vx_load(out.samples + i), all[0]));
        for (int d = 0; d < 2; d++)
        {
            const v_int16 derivative = vx_load(out.derivatives[d] + i);
            v_store(out.derivatives[2 + 2 * d] + i, v_mul_hi(derivative, vx_load(weights.x + i)));
            v_store(out.derivatives[3 + 2 * d] + i, v_mul_hi(derivative, vx_load(weights.y + i)));
            v_store(out.weights[1 + d] + i, v_mul_hi(derivative, all[0]));
            v_store(out.weights[3 + 2 * d] + i, v_mul_hi(derivative, all[1]));
            v_store(out.weights[4 + 2 * d] + i, v_mul_hi(derivative, all[2]));
        }
    }
}

void sum(const short* samples, const PatchWeights& weights, const PatchTemplate& patch, int* sums)
{
    v_int32 products[SUMS];
    for (v_int32& product : products)
        product = vx_setzero_s32();
    for (int i = 0; i < PATCH_SAMPLES; i += SHORTS)
    {
        const v_int16 sample = vx_load(samples + i), weight = vx_load(weights.gaussian + i);
        products[SUM_SAMPLES] += v_dotprod(sample, weight >> (15 - WEIGHT_BITS));
        products[SUM_SQUARES] += v_dotprod(sample, v_mul_hi(sample, weight));
        for (int k = SUM_TEMPLATE; k < SUMS; k++)
            products[k] += v_dotprod(sample, vx_load(patch.weights[k - SUM_TEMPLATE] + i));
    }
    for (int k = 0; k < SUMS; k++)
        sums[k] = v_reduce_sum(products[k]);
}

void sumProducts(const PatchTemplate& patch, int (*sums)[PARAMETERS])
{
    for (int i = 0; i < PARAMETERS; i++)
    {
        const short* const weights = patch.weights[1 + i];
        v_int32 products[PARAMETERS];
        for (v_int32& product : products)
            product = vx_setzero_s32();
        for (int s = 0; s < PATCH_SAMPLES; s += SHORTS)
        {
            const v_int16 weight = vx_load(weights + s);
            for (int j = 0; j < PARAMETERS; j++)
                products[j] += v_dotprod(weight, vx_load(patch.derivatives[j] + s));
        }
        for (int j = 0; j <= i; j++)
            sums[i][j] = v_reduce_sum(products[j]);
    }
}

// The compiler makes vectors of this and the last function's loops.
void subtract(const short* samples, const PatchWeights& weights, const PatchTemplate& patch, int gain,
        int offset, short* residuals)
{
    const int largest = 4095;  // so that sums of squares fit 32 bits
    for (int i = 0; i < PATCH_SAMPLES; i++)
    {
        const int residual = samples[i] - ((gain * patch.samples[i] + offset) >> GAIN_BITS);
        const int limited = std::min(std::max(residual, -largest), largest);
        residuals[i] = (short)(limited * weights.gaussian[i] >> 16);
    }
}

Autocorrelation autocorrelate(const short* values)
{
    Autocorrelation sums = {0, 0, 0};
    for (int i = 0; i < PATCH_SAMPLES; i++)
        sums.squares += values[i] * values[i];
    for (int i = 0; i < PATCH_SAMPLES - PATCH; i++)
    {
        sums.right += values[i] * values[i + 1];
        sums.below += values[i] * values[i + PATCH];
    }
    return sums;
}

}  // namespace

const RefinementKernels& refinementKernels()
{
    static const RefinementKernels kernels = {
            smooth, readWindow, sample, makeTemplate, sum, sumProducts, subtract, autocorrelate};
    return kernels;
}

CV_CPU_OPTIMIZATION_NAMESPACE_END

}  // namespace iib
}  // namespace cv

#endif
