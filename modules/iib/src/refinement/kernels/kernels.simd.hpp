// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "kernels.hpp"

namespace cv { namespace iib {
CV_CPU_OPTIMIZATION_NAMESPACE_BEGIN
const RefinementKernels& refinementKernels();
CV_CPU_OPTIMIZATION_NAMESPACE_END
}}  // namespace cv::iib

#ifndef CV_CPU_OPTIMIZATION_DECLARATIONS_ONLY

#include "../../common/vectors.simd.hpp"

namespace cv { namespace iib {
CV_CPU_OPTIMIZATION_NAMESPACE_BEGIN
namespace {

static_assert(PATCH % INTS == 0 && PATCH_SAMPLES % SHORTS == 0, "vectors fit rows and patches");

void smooth(const uchar* const rows[3], ushort* sums, uchar* out, int width)
{
    for (int x = 0; x < width; x++)  // at -O3 compilers make vectors of it
        sums[1 + x] = (ushort)(rows[0][x] + 2 * rows[1][x] + rows[2][x]);
    sums[0] = sums[1];
    sums[width + 1] = sums[width];
    int x = 0;
    for (; x <= width - SHORTS; x += SHORTS)
        v_pack_store(out + x, (vx_load(sums + x) + vx_load(sums + x + 2) + (vx_load(sums + x + 1) << 1) +
                                      vx_setall_u16(8)) >>
                                      4);
    for (; x < width; x++)
        out[x] = (uchar)((sums[x] + 2 * sums[x + 1] + sums[x + 2] + 8) >> 4);
}

void readWindow(const uchar* pixels, size_t step, Size size, ushort* window)
{
    const v_uint8 signs = vx_setall_u8(128);
    for (int y = 0; y < size.height; y++, pixels += step, window += WINDOW_STEP)
    {
        int x = 0;
        for (; x < size.width; x += 2 * SHORTS)
        {
            v_uint8 first, second;
            v_zip(vx_load(pixels + x) ^ signs, vx_load(pixels + step + x) ^ signs, first, second);
            v_store(window + x, v_reinterpret_as_u16(first));
            v_store(window + x + SHORTS, v_reinterpret_as_u16(second));
        }
        if (x == size.width)
            window[x] = (ushort)((pixels[x] | pixels[step + x] << 8) ^ 0x8080);
    }
}

inline v_int32 samplesAt(const ushort* window, const v_int32& x, const v_int32& y)
{
    const v_int32 rows = (y >> (POSITION_BITS - WINDOW_BITS - 1)) & vx_setall_s32(-WINDOW_STEP);
    const v_int32 places = rows + (x >> POSITION_BITS);
    // two columns, each a pixel and the one below; then the fractions of the position, in 2^-8 pixels
    const v_int16 four = v_reinterpret_as_s16(gatherWords<sizeof(*window)>(window, places));
    const v_int32 right = x & vx_setall_s32(0xff00), down = y & vx_setall_s32(0xff00);
    // 256 * upper + down * (lower - upper), modulo 2^16: the result fits
    const v_int16 upper = four << 8, difference = v_sub_wrap(four >> 8, upper >> 8);
    const v_int16 columns =
            v_add_wrap(upper, v_mul_wrap(difference, v_reinterpret_as_s16((down << 8) | (down >> 8))));
    const v_int32 weights = (right << 8) + (vx_setall_s32(256) - (right >> 8));
    const v_int32 sample = v_dotprod(columns, v_reinterpret_as_s16(weights));
    return (sample + vx_setall_s32(1 << (15 - SAMPLE_BITS))) >> (16 - SAMPLE_BITS);
}

void sample(const ushort* window, const PatchGrid& grid, short* samples)
{
    const int VECTORS = PATCH / INTS;  // of a row
    v_int32 x[VECTORS], y[VECTORS];
    for (int i = 0; i < VECTORS; i++)
    {
        int columns[INTS];
        for (int k = 0; k < INTS; k++)
            columns[k] = i * INTS + k;
        x[i] = vx_setall_s32(grid.first.x) + vx_load(columns) * vx_setall_s32(grid.column.x);
        y[i] = vx_setall_s32(grid.first.y) + vx_load(columns) * vx_setall_s32(grid.column.y);
    }
    const v_int32 rowX = vx_setall_s32(grid.row.x), rowY = vx_setall_s32(grid.row.y);
    const auto next = [&](int i) {
        const v_int32 result = samplesAt(window, x[i], y[i]);
        x[i] += rowX;
        y[i] += rowY;
        return result;
    };
    for (const short* end = samples + PATCH_SAMPLES; samples < end;)
        for (int i = 0; i < std::max(VECTORS, 2); i += 2, samples += SHORTS)
        {
            const v_int32 first = next(i % VECTORS), second = next((i + 1) % VECTORS);
            v_store(samples, v_pack(first, second));
        }
}

CoarseSums coarseSums(const uchar* pixels1, size_t step1, const uchar* pixels2, size_t step2,
        const Point (&rows)[COARSE_PIXELS], const Point& column)
{
    static const int WEIGHTS[COARSE_PIXELS] = {1, 2, 3, 4, 4, 3, 2, 1};  // about a Gaussian of 8 pixels
    static const int COLUMNS[COARSE_PIXELS] = {0, 1, 2, 3, 4, 5, 6, 7};
    const v_samples byte = v_setall_samples(255), middle = v_setall_samples(128);
    const auto product = [](const v_samples& a, const v_samples& b) {  // of 16-bit values; b >= 0
        return v_dotprod(v_reinterpret_as_s16(a), v_reinterpret_as_s16(b));
    };
    const auto positive = [](const v_samples& v) { return v & v_setall_samples(0xffff); };
    v_samples sums[5];
    for (v_samples& sum : sums)
        sum = v_setall_samples(0);
    for (int y = 0; y < COARSE_PIXELS; y++, pixels1 += COARSE_STEP * step1)
        for (int x = 0; x < COARSE_PIXELS; x += VTraits<v_samples>::max_nlanes)
        {
            const v_samples columns = v_load_samples(COLUMNS + x);
            const v_samples weights = v_load_samples(WEIGHTS + x) * v_setall_samples(WEIGHTS[y]);
            const auto place = [&](int first, int step) {
                return (v_setall_samples(first) + columns * v_setall_samples(step)) >> POSITION_BITS;
            };
            const v_samples offsets =
                    place(rows[y].y, column.y) * v_setall_samples((int)step2) + place(rows[y].x, column.x);
            const v_samples first = (v_load_words(pixels1 + COARSE_STEP * x) & byte) - middle;
            const v_samples second = (gatherWords<1>(pixels2, offsets) & byte) - middle;
            const v_samples weighted1 = product(first, weights), weighted2 = product(second, weights);
            sums[0] += weighted1;
            sums[1] += weighted2;
            sums[2] += product(first, positive(weighted1));
            sums[3] += product(second, positive(weighted2));
            sums[4] += product(second, positive(weighted1));
        }
    return {v_reduce_sum(sums[0]), v_reduce_sum(sums[1]), v_reduce_sum(sums[2]), v_reduce_sum(sums[3]),
            v_reduce_sum(sums[4])};
}

SquaredDifferences squareDifferences(const uchar* pixels, size_t step, ptrdiff_t next)
{
    static const short INSIDE[] = {-1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1,
            -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, 0};
    v_int32 first = vx_setzero_s32(), second = vx_setzero_s32();
    for (int y = 2; y < TEMPLATE - 1; y += 4)
        for (int x = 1; x < TEMPLATE - 1; x += SHORTS)
        {
            const auto pixelsAt = [&](ptrdiff_t offset) {
                return v_reinterpret_as_s16(vx_load_expand(pixels + y * step + x + offset));
            };
            const v_int16 inside = vx_load(INSIDE + x - 1), centre = pixelsAt(0);
            const v_int16 before = (centre - pixelsAt(-next)) & inside;
            const v_int16 after = (pixelsAt(next) - centre) & inside;
            first += v_dotprod(after, after);
            second += v_dotprod(after - before, after - before);
        }
    return {v_reduce_sum(first), v_reduce_sum(second)};
}

//! Every second pixel, from the second on.
inline auto everySecond(const uchar* pixels) -> decltype(v_reinterpret_as_s16(v_load_words(pixels)))
{
    return v_reinterpret_as_s16(v_reinterpret_as_u16(v_load_words(pixels)) >> 8);
}

void readTemplate(const uchar* pixels, size_t step, PatchTemplate& out)
{
    const auto middle = v_reinterpret_as_s16(v_setall_samples((128 << SAMPLE_BITS) * 0x10001));
    for (int i = 0; i < PATCH_SAMPLES; i += 2 * VTraits<v_samples>::max_nlanes)
    {
        const uchar* const p = pixels + (2 * (i / PATCH) + 1) * step + 2 * (i % PATCH);
        v_store(out.samples + i, (everySecond(p) << SAMPLE_BITS) - middle);
        v_store(out.derivatives[0] + i, (everySecond(p + 1) - everySecond(p - 1)) << (SAMPLE_BITS - 1));
        v_store(out.derivatives[1] + i, (everySecond(p + step) - everySecond(p - step)) << (SAMPLE_BITS - 1));
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

//! A row of sumProducts(); I is a constant so that compilers unroll its loop.
template <int I> void sumProductsOf(const PatchTemplate& patch, int (*sums)[PARAMETERS])
{
    v_int32 products[I + 1];
    for (v_int32& product : products)
        product = vx_setzero_s32();
    for (int s = 0; s < PATCH_SAMPLES; s += SHORTS)
    {
        const v_int16 weight = vx_load(patch.weights[1 + I] + s);
        for (int j = 0; j <= I; j++)
            products[j] += v_dotprod(weight, vx_load(patch.derivatives[j] + s));
    }
    for (int j = 0; j <= I; j++)
        sums[I][j] = v_reduce_sum(products[j]);
}

void sumProducts(const PatchTemplate& patch, int (*sums)[PARAMETERS])
{
    sumProductsOf<0>(patch, sums);
    sumProductsOf<1>(patch, sums);
    sumProductsOf<2>(patch, sums);
    sumProductsOf<3>(patch, sums);
    sumProductsOf<4>(patch, sums);
    sumProductsOf<5>(patch, sums);
}

// Compilers vectorize the loops of this function and the next.
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
    static const RefinementKernels kernels = {smooth, readWindow, sample, coarseSums, squareDifferences,
            makeTemplate, sum, sumProducts, subtract, autocorrelate};
    return kernels;
}

CV_CPU_OPTIMIZATION_NAMESPACE_END
}}  // namespace cv::iib

#endif
