// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "../../common/vectors.simd.hpp"

#include "kernels.hpp"

namespace cv {
namespace iib {

CV_CPU_OPTIMIZATION_NAMESPACE_BEGIN

const RefinementKernels& refinementKernels();

#ifndef CV_CPU_OPTIMIZATION_DECLARATIONS_ONLY

namespace {

constexpr int SHORTS = VTraits<v_int16>::max_nlanes, INTS = VTraits<v_int32>::max_nlanes;

void smooth(const uchar* const rows[3], uchar* out, int width)
{
    const auto sum = [&](int x) { return rows[0][x] + 2 * rows[1][x] + rows[2][x]; };
    const auto smoothed = [&](int x) {
        return (uchar)((sum(std::max(x - 1, 0)) + 2 * sum(x) + sum(std::min(x + 1, width - 1)) + 8) >> 4);
    };
    const auto sums = [&](int x) {
        return vx_load_expand(rows[0] + x) + vx_load_expand(rows[2] + x) + (vx_load_expand(rows[1] + x) << 1);
    };
    int x = 0;
    for (; x < std::min(width, 1); x++)
        out[x] = smoothed(x);
    for (; x < width - SHORTS; x += SHORTS)
        v_pack_store(out + x, (sums(x - 1) + sums(x + 1) + (sums(x) << 1) + vx_setall_u16(8)) >> 4);
    for (; x < width; x++)
        out[x] = smoothed(x);
}

inline v_int32 pixels(const uchar* p) { return v_reinterpret_as_s32(vx_load_expand_q(p)); }

void readWindow(const uchar* upper, const uchar* lower, int* out, int width)
{
    const v_int32 signs = vx_setall_s32((int)0x80808080);
    for (int x = 0; x < width; x += INTS)
    {
        const v_int32 left = pixels(upper + x) | (pixels(lower + x) << 8);
        const v_int32 right = pixels(upper + x + 1) | (pixels(lower + x + 1) << 8);
        v_store(out + x, (left | (right << 16)) ^ signs);
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

void sample(const int* window, const PatchGrid& grid, int rowStep, short* samples)
{
    int columns[INTS];
    for (int i = 0; i < INTS; i++)
        columns[i] = i;
    const v_int32 column = vx_load(columns);
    const v_int32 x = column * vx_setall_s32(grid.column.x), y = column * vx_setall_s32(grid.column.y);
    for (int r = 0; r < PATCH_ROWS; r += rowStep)
    {
        const Point row = grid.first + r * grid.row;
        for (int c = 0; c < PATCH_COLUMNS; c += 2 * INTS)
        {
            const Point left = row + c * grid.column, right = left + INTS * grid.column;
            v_store(samples + r * PATCH_COLUMNS + c,
                    v_pack(samplesAt(window, x + vx_setall_s32(left.x), y + vx_setall_s32(left.y)),
                            samplesAt(window, x + vx_setall_s32(right.x), y + vx_setall_s32(right.y))));
        }
    }
}

int sum(const short* samples, const short* const* weights, const short* roots, int rowStep, int* sums)
{
    v_int32 products[SUMS], squares = vx_setzero_s32();
    for (v_int32& product : products)
        product = vx_setzero_s32();
    for (int r = 0; r < PATCH_ROWS; r += rowStep)
        for (int i = r * PATCH_COLUMNS; i < (r + 1) * PATCH_COLUMNS; i += SHORTS)
        {
            const v_int16 sample = vx_load(samples + i), root = v_mul_hi(sample, vx_load(roots + i));
            squares += v_dotprod(root, root);
            for (int k = 0; k < SUMS; k++)
                products[k] += v_dotprod(sample, vx_load(weights[k] + i));
        }
    for (int k = 0; k < SUMS; k++)
        sums[k] = v_reduce_sum(products[k]);
    return v_reduce_sum(squares);
}

void derive(const short* samples, short* x, short* y)
{
    for (int r = 0; r < PATCH_ROWS; r++)
    {
        const short* row = samples + r * PATCH_COLUMNS;
        const short* above = r > 0 ? row - PATCH_COLUMNS : row;
        const short* below = r < PATCH_ROWS - 1 ? row + PATCH_COLUMNS : row;
        short *outX = x + r * PATCH_COLUMNS, *outY = y + r * PATCH_COLUMNS;
        for (int c = 0; c < PATCH_COLUMNS; c++)
            outY[c] = (short)(below[c] - above[c]);
        for (int c = 1; c < PATCH_COLUMNS - 1; c++)
            outX[c] = (short)(row[c + 1] - row[c - 1]);
        outX[0] = (short)(row[1] - row[0]);
        outX[PATCH_COLUMNS - 1] = (short)(row[PATCH_COLUMNS - 1] - row[PATCH_COLUMNS - 2]);
    }
}

inline v_float32 floats(const short* p) { return v_cvt_f32(vx_load_expand(p)); }

void sumColumns(const short* x, const short* y, const PatchWeights& weights, float (*sums)[PATCH_COLUMNS])
{
    for (int c = 0; c < PATCH_COLUMNS; c += INTS)
    {
        v_float32 s[COLUMN_SUMS];
        for (v_float32& sum : s)
            sum = vx_setzero_f32();
        for (int r = 0; r < PATCH_ROWS; r++)
        {
            const v_float32 dx = floats(x + r * PATCH_COLUMNS + c), dy = floats(y + r * PATCH_COLUMNS + c);
            const v_float32 w = vx_setall_f32(weights.rows[r]), place = vx_setall_f32(weights.y[r]);
            const v_float32 x1 = dx * w, y1 = dy * w, products[] = {x1 * dx, x1 * dy, y1 * dy};
            for (int k = 0; k < 3; k++)
            {
                const v_float32 once = products[k] * place;
                s[3 * k] += products[k];
                s[3 * k + 1] += once;
                s[3 * k + 2] += once * place;
            }
            s[COLUMN_X] += x1;
            s[COLUMN_X + 1] += x1 * place;
            s[COLUMN_Y] += y1;
            s[COLUMN_Y + 1] += y1 * place;
        }
        for (int k = 0; k < COLUMN_SUMS; k++)
            v_store(sums[k] + c, s[k]);
    }
}

//! The weights of INTS samples, the template's and those of the derivatives.
struct SampleWeights
{
    v_int32 values[SUMS - SUM_TEMPLATE];

    SampleWeights(const short* samples, const short* x, const short* y, const PatchWeights& weights, int row,
            int column, float mean, const float* scales)
    {
        const int i = row * PATCH_COLUMNS + column;
        const v_float32 w = vx_load(weights.columns + column) * vx_setall_f32(weights.rows[row]);
        const v_float32 placeX = vx_load(weights.x + column), placeY = vx_setall_f32(weights.y[row]);
        const v_float32 dx = floats(x + i) * w, dy = floats(y + i) * w;
        const v_float32 all[] = {(floats(samples + i) - vx_setall_f32(mean)) * w, dx, dy, dx * placeX,
                dx * placeY, dy * placeX, dy * placeY};
        for (int k = 0; k < SUMS - SUM_TEMPLATE; k++)
            values[k] = nearestInt(all[k] * vx_setall_f32(scales[k]));
    }
};

void weigh(const short* samples, const short* x, const short* y, const PatchWeights& weights, float mean,
        const float* scales, short* const* out)
{
    for (int r = 0; r < PATCH_ROWS; r++)
        for (int c = 0; c < PATCH_COLUMNS; c += SHORTS)
        {
            const SampleWeights left(samples, x, y, weights, r, c, mean, scales);
            const SampleWeights right(samples, x, y, weights, r, c + INTS, mean, scales);
            for (int k = 0; k < SUMS - SUM_TEMPLATE; k++)
                v_store(out[k] + r * PATCH_COLUMNS + c, v_pack(left.values[k], right.values[k]));
        }
}

}  // namespace

const RefinementKernels& refinementKernels()
{
    static const RefinementKernels kernels = {smooth, readWindow, sample, sum, derive, sumColumns, weigh};
    return kernels;
}

#endif

CV_CPU_OPTIMIZATION_NAMESPACE_END

}  // namespace iib
}  // namespace cv
