// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "../../src/refinement/kernels/kernels.hpp"
#include "../support/test_images.hpp"

namespace opencv_test {
namespace {

//! Kernels beside what they say they do, written down one value after the other.
class IIB_RefinementKernels : public testing::Test
{
protected:
    IIB_RefinementKernels() : kernels(refinementKernels()), integers(1) {}

    template <typename T> std::vector<T> random(size_t n, int begin, int end)
    {
        std::vector<T> values(n);
        for (T& value : values)
            value = (T)integers.between(begin, end);
        return values;
    }

    PatchWeights randomWeights()
    {
        PatchWeights w;
        for (float& value : w.columns)
            value = (float)integers.below(1000) / 16384;
        for (float& value : w.rows)
            value = (float)integers.below(1000) / 16384;
        for (int i = 0; i < PATCH_COLUMNS; i++)
            w.x[i] = (float)(i - 15.5) / 16;
        for (int i = 0; i < PATCH_ROWS; i++)
            w.y[i] = (float)(i - 13.5) / 16;
        return w;
    }

    const RefinementKernels& kernels;
    Integers integers;
};

const int SHIFTS = 5;  //!< of where rows and patches begin in memory

TEST_F(IIB_RefinementKernels, smooth)
{
    for (int width = 1; width < 150; width++)
    {
        const std::vector<uchar> image = random<uchar>(3 * 200, 0, 256);
        const int shift = width % SHIFTS;
        const uchar* const rows[] = {&image[shift], &image[200 + shift], &image[400 + shift]};
        std::vector<uchar> actual(width + 1, 77), expected(actual);
        for (int x = 0; x < width; x++)
        {
            int sum = 8;
            for (int dx = -1; dx <= 1; dx++)
                for (int dy = 0; dy < 3; dy++)
                    sum += (2 - std::abs(dx)) * (2 - std::abs(dy - 1)) *
                           rows[dy][std::min(std::max(x + dx, 0), width - 1)];
            expected[x] = (uchar)(sum / 16);
        }
        kernels.smooth(rows, actual.data(), width);
        ASSERT_EQ(expected, actual) << width;
    }
}

TEST_F(IIB_RefinementKernels, readWindow)
{
    for (int width = 1; width <= WINDOW; width++)
    {
        const std::vector<uchar> upper = random<uchar>(2 * WINDOW_PADDING + SHIFTS, 0, 256),
                                 lower = random<uchar>(upper.size(), 0, 256);
        const uchar *a = &upper[width % SHIFTS], *b = &lower[width % 3];
        std::vector<int> window(width + WINDOW_PADDING);
        kernels.readWindow(a, b, window.data(), width);
        for (int x = 0; x < width; x++)
        {
            const uchar pixels[] = {a[x], b[x], a[x + 1], b[x + 1]};
            for (int i = 0; i < 4; i++)
                ASSERT_EQ(pixels[i] - 128, (schar)(window[x] >> 8 * i)) << width << ", " << x;
        }
    }
}

TEST_F(IIB_RefinementKernels, sample)
{
    for (int trial = 0; trial < 50; trial++)
    {
        const std::vector<int> window = random<int>(WINDOW * WINDOW, INT_MIN / 2, INT_MAX / 2);
        const auto step = [&] { return trial == 0 ? 0 : integers.between(-65536, 65536); };
        PatchGrid grid = {Point(), Point(step() * 2 / 3, step() / 3), Point(step() / 3, step() * 2 / 3)};
        if (trial == 1)
            grid = {Point(), Point(65536, 0), Point(0, 65536)};
        Point least, most;  // of what is added to the first place
        for (int i : {0, PATCH_COLUMNS - 1})
            for (int j : {0, PATCH_ROWS - 1})
            {
                const Point place = i * grid.column + j * grid.row;
                least = Point(std::min(least.x, place.x), std::min(least.y, place.y));
                most = Point(std::max(most.x, place.x), std::max(most.y, place.y));
            }
        const int end = WINDOW << POSITION_BITS;
        ASSERT_LT(std::max(most.x - least.x, most.y - least.y), end);
        grid.first =
                Point(integers.between(-least.x, end - most.x), integers.between(-least.y, end - most.y));
        std::vector<short> samples(PATCH_SAMPLES + SHIFTS);
        short* const actual = &samples[trial % SHIFTS];
        const int rowStep = 1 + trial % 2;
        kernels.sample(window.data(), grid, rowStep, actual);
        for (int i = 0; i < PATCH_SAMPLES; i++)
        {
            if (i / PATCH_COLUMNS % rowStep != 0)
                continue;
            const Point place = grid.first + i % PATCH_COLUMNS * grid.column + i / PATCH_COLUMNS * grid.row;
            const int pixels = window[(place.y >> 16) * WINDOW + (place.x >> 16)];
            const int right = (place.x & 65535) / 256, down = (place.y & 65535) / 256;
            const int sum = (schar)pixels * (256 - right) * (256 - down) +
                            (schar)(pixels >> 8) * (256 - right) * down +
                            (schar)(pixels >> 16) * right * (256 - down) +
                            (schar)(pixels >> 24) * right * down;
            ASSERT_EQ((int)std::floor(sum / 1024. + .5), actual[i]) << trial << ", " << i;
        }
    }
}

TEST_F(IIB_RefinementKernels, sum)
{
    for (int shift = 0; shift < SHIFTS; shift++)
    {
        const std::vector<short> samples = random<short>(PATCH_SAMPLES + SHIFTS, -8192, 8128),
                                 roots = random<short>(PATCH_SAMPLES, 0, 16384);
        std::vector<std::vector<short>> weights;
        const short* pointers[SUMS];
        for (int k = 0; k < SUMS; k++)
        {
            weights.push_back(random<short>(PATCH_SAMPLES + SHIFTS, -290, 290));
            pointers[k] = &weights[k][(shift + k) % SHIFTS];
        }
        for (int rowStep : {1, 2})
        {
            int sums[SUMS], expected[SUMS] = {}, expectedSquares = 0;
            const int squares = kernels.sum(&samples[shift], pointers, roots.data(), rowStep, sums);
            for (int i = 0; i < PATCH_SAMPLES; i++)
            {
                if (i / PATCH_COLUMNS % rowStep != 0)
                    continue;
                expectedSquares += (int)std::pow(std::floor(samples[shift + i] * roots[i] / 65536.), 2);
                for (int k = 0; k < SUMS; k++)
                    expected[k] += samples[shift + i] * pointers[k][i];
            }
            EXPECT_EQ(expectedSquares, squares);
            for (int k = 0; k < SUMS; k++)
                EXPECT_EQ(expected[k], sums[k]) << k;
        }
    }
}

TEST_F(IIB_RefinementKernels, derive_sumColumns_and_weigh)
{
    for (int shift = 0; shift < SHIFTS; shift++)
    {
        const PatchWeights weights = randomWeights();
        const std::vector<short> memory = random<short>(PATCH_SAMPLES + SHIFTS, -8192, 8128);
        const short* const samples = &memory[shift];
        std::vector<short> x(PATCH_SAMPLES + SHIFTS), y(x);
        kernels.derive(samples, &x[shift], &y[shift]);
        const auto at = [&](int row, int column) {
            return samples[std::min(std::max(row, 0), PATCH_ROWS - 1) * PATCH_COLUMNS +
                           std::min(std::max(column, 0), PATCH_COLUMNS - 1)];
        };
        float actual[COLUMN_SUMS][PATCH_COLUMNS];
        kernels.sumColumns(&x[shift], &y[shift], weights, actual);
        const float scales[] = {3, 2, .5f, .25f, 1, 40, 1};  // the last but one too large for 16 bits
        std::vector<short> out(7 * (PATCH_SAMPLES + SHIFTS));
        short* pointers[7];
        for (int k = 0; k < 7; k++)
            pointers[k] = &out[k * (PATCH_SAMPLES + SHIFTS) + shift];
        kernels.weigh(samples, &x[shift], &y[shift], weights, 123.5f, scales, pointers);
        for (int c = 0; c < PATCH_COLUMNS; c++)
        {
            float sums[COLUMN_SUMS] = {};
            for (int r = 0; r < PATCH_ROWS; r++)
            {
                const int i = r * PATCH_COLUMNS + c;
                const float dx = (float)(at(r, c + 1) - at(r, c - 1)),
                            dy = (float)(at(r + 1, c) - at(r - 1, c));
                ASSERT_EQ(dx, x[shift + i]) << r << ", " << c;
                ASSERT_EQ(dy, y[shift + i]) << r << ", " << c;
                const float wx = dx * weights.rows[r], wy = dy * weights.rows[r], place = weights.y[r];
                const float terms[] = {wx * dx, wx * dx * place, wx * dx * place * place, wx * dy,
                        wx * dy * place, wx * dy * place * place, wy * dy, wy * dy * place,
                        wy * dy * place * place, wx, wx * place, wy, wy * place};
                for (int k = 0; k < COLUMN_SUMS; k++)
                    sums[k] += terms[k];
                const float w = weights.columns[c] * weights.rows[r], px = weights.x[c];
                const float values[] = {(at(r, c) - 123.5f) * w, dx * w, dy * w, dx * w * px, dx * w * place,
                        dy * w * px, dy * w * place};
                for (int k = 0; k < 7; k++)
                    ASSERT_EQ(saturate_cast<short>(cvRound(values[k] * scales[k])), pointers[k][i])
                            << k << ", " << i;
            }
            for (int k = 0; k < COLUMN_SUMS; k++)
                ASSERT_EQ(sums[k], actual[k][c]) << k << ", " << c;
        }
    }
}

}  // namespace
}  // namespace opencv_test
