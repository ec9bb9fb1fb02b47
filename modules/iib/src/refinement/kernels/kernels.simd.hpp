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

void smooth(const uchar* const rows[3], uchar* out, int width)
{
    const auto sum = [&](int x) { return rows[0][x] + 2 * rows[1][x] + rows[2][x]; };
    for (int x = 0; x < width; x++)
        out[x] = (uchar)((sum(std::max(x - 1, 0)) + 2 * sum(x) + sum(std::min(x + 1, width - 1)) + 8) >> 4);
}

//! Part of the way from a to b, in 2^-8.
inline int between(int a, int b, int part) { return a * (256 - part) + b * part; }

void sample(const int* window, const PatchGrid& grid, short* samples)
{
    constexpr int ROUNDING = 1 << (15 - SAMPLE_BITS);
    for (int i = 0; i < PATCH_SAMPLES; i++)
    {
        const int column = i % PATCH_COLUMNS, row = i / PATCH_COLUMNS;
        const int x = grid.first.x + column * grid.column.x + row * grid.row.x;
        const int y = grid.first.y + column * grid.column.y + row * grid.row.y;
        const int pixels = window[(y >> POSITION_BITS) * WINDOW + (x >> POSITION_BITS)];
        const int partX = (x >> 8) & 255, partY = (y >> 8) & 255;
        const int upper = between((schar)pixels, (schar)(pixels >> 16), partX);
        const int lower = between((schar)(pixels >> 8), (schar)(pixels >> 24), partX);
        samples[i] = (short)((between(upper, lower, partY) + ROUNDING) >> (16 - SAMPLE_BITS));
    }
}

int sum(const short* samples, const short* const* weights, int count, const short* roots, int* sums)
{
    for (int k = 0; k < count; k++)
    {
        sums[k] = 0;
        for (int i = 0; i < PATCH_SAMPLES; i++)
            sums[k] += samples[i] * weights[k][i];
    }
    int squares = 0;
    for (int i = 0; i < PATCH_SAMPLES; i++)
    {
        const int root = samples[i] * roots[i] >> 16;
        squares += root * root;
    }
    return squares;
}

//! Derivatives of a template at one of its samples.
struct Derivatives
{
    float x, y;

    Derivatives(const short* samples, int row, int column)
    {
        const short* here = samples + row * PATCH_COLUMNS;
        x = (float)(here[std::min(column + 1, PATCH_COLUMNS - 1)] - here[std::max(column - 1, 0)]);
        y = (float)(samples[std::min(row + 1, PATCH_ROWS - 1) * PATCH_COLUMNS + column] -
                    samples[std::max(row - 1, 0) * PATCH_COLUMNS + column]);
    }
};

void sumColumns(const short* samples, const PatchWeights& weights, float (*sums)[PATCH_COLUMNS])
{
    for (int c = 0; c < PATCH_COLUMNS; c++)
    {
        float s[COLUMN_SUMS] = {};
        for (int r = 0; r < PATCH_ROWS; r++)
        {
            const Derivatives d(samples, r, c);
            const float y = weights.y[r], x1 = d.x * weights.rows[r], y1 = d.y * weights.rows[r];
            const float products[] = {x1 * d.x, x1 * d.y, y1 * d.y};
            for (int k = 0; k < 3; k++)
            {
                const float once = products[k] * y;
                s[3 * k] += products[k];
                s[3 * k + 1] += once;
                s[3 * k + 2] += once * y;
            }
            s[COLUMN_X] += x1;
            s[COLUMN_X + 1] += x1 * y;
            s[COLUMN_Y] += y1;
            s[COLUMN_Y + 1] += y1 * y;
        }
        for (int k = 0; k < COLUMN_SUMS; k++)
            sums[k][c] = s[k];
    }
}

void weigh(
        const short* samples, const PatchWeights& weights, float mean, const float* scales, short* const* out)
{
    for (int i = 0; i < PATCH_SAMPLES; i++)
    {
        const int r = i / PATCH_COLUMNS, c = i % PATCH_COLUMNS;
        const Derivatives d(samples, r, c);
        const float w = weights.columns[c] * weights.rows[r], dx = d.x * w, dy = d.y * w;
        const float values[] = {(samples[i] - mean) * w, dx, dy, dx * weights.x[c], dx * weights.y[r],
                dy * weights.x[c], dy * weights.y[r]};
        for (int k = 0; k < SUMS - SUM_TEMPLATE; k++)
            out[k][i] = saturate_cast<short>(cvRound(values[k] * scales[k]));
    }
}

}  // namespace

const RefinementKernels& refinementKernels()
{
    static const RefinementKernels kernels = {smooth, sample, sum, sumColumns, weigh};
    return kernels;
}

#endif

CV_CPU_OPTIMIZATION_NAMESPACE_END

}  // namespace iib
}  // namespace cv
