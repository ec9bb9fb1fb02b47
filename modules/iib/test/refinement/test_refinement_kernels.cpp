// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "../../src/refinement/kernels/kernels.hpp"
#include "../support/test_images.hpp"

namespace opencv_test { namespace {

//! Kernels beside scalar loops.
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
        for (short* values : {w.gaussian, w.gaussianX, w.gaussianY, w.x, w.y})
            for (int i = 0; i < PATCH_SAMPLES; i++)
                values[i] = (short)(values == w.gaussian ? integers.below(32768)
                                                         : integers.between(-32767, 32768));
        return w;
    }

    const RefinementKernels& kernels;
    Integers integers;
};

const int SHIFTS = 5;  //!< alignments of rows and patches

TEST_F(IIB_RefinementKernels, smooth)
{
    for (int width = 1; width < 150; width++)
    {
        const std::vector<uchar> image = random<uchar>(3 * 200, 0, 256);
        const int shift = width % SHIFTS;
        const uchar* const rows[] = {&image[shift], &image[200 + shift], &image[400 + shift]};
        std::vector<uchar> actual(width + 1, 77), expected(actual);
        std::vector<ushort> sums(width + 2);
        for (int x = 0; x < width; x++)
        {
            int sum = 8;
            for (int dx = -1; dx <= 1; dx++)
                for (int dy = 0; dy < 3; dy++)
                    sum += (2 - std::abs(dx)) * (2 - std::abs(dy - 1)) *
                           rows[dy][std::min(std::max(x + dx, 0), width - 1)];
            expected[x] = (uchar)(sum / 16);
        }
        kernels.smooth(rows, sums.data(), actual.data(), width);
        ASSERT_EQ(expected, actual) << width;
    }
}

TEST_F(IIB_RefinementKernels, readWindow)
{
    for (int width = 1; width <= WINDOW; width++)
    {
        const Size size(width, width % SHIFTS + 1);
        const size_t step = WINDOW + 1 + width % 3;
        const std::vector<uchar> image = random<uchar>((size.height + 1) * step + SHIFTS, 0, 256);
        const uchar* const pixels = &image[width % SHIFTS];
        std::vector<ushort> window(size.height * WINDOW_STEP);
        kernels.readWindow(pixels, step, size, window.data());
        for (int y = 0; y < size.height; y++)
            for (int x = 0; x <= width; x++)
            {
                const uchar* const p = pixels + y * step + x;
                const int both = window[y * WINDOW_STEP + x];
                ASSERT_EQ(p[0] - 128, (schar)both) << width << ", " << x;
                ASSERT_EQ(p[step] - 128, (schar)(both >> 8)) << width << ", " << x;
            }
    }
}

TEST_F(IIB_RefinementKernels, sample)
{
    for (int trial = 0; trial < 50; trial++)
    {
        const std::vector<ushort> window = random<ushort>(WINDOW * WINDOW_STEP, 0, 65536);
        const auto step = [&] { return trial == 0 ? 0 : integers.between(-131072, 131072); };
        PatchGrid grid = {Point(), Point(step() * 2 / 3, step() / 3), Point(step() / 3, step() * 2 / 3)};
        if (trial == 1)
            grid = {Point(), Point(131072, 0), Point(0, 131072)};
        Point least, most;  // offsets from the first sample
        for (int i : {0, PATCH - 1})
            for (int j : {0, PATCH - 1})
            {
                const Point place = i * grid.column + j * grid.row;
                least = Point(std::min(least.x, place.x), std::min(least.y, place.y));
                most = Point(std::max(most.x, place.x), std::max(most.y, place.y));
            }
        const int end = WINDOW << POSITION_BITS;
        ASSERT_LT(std::max(most.x - least.x, most.y - least.y), end);
        grid.first.y = integers.between(-least.y, end - most.y);
        grid.first.x = integers.between(-least.x, end - most.x);
        std::vector<short> samples(PATCH_SAMPLES + SHIFTS);
        short* const actual = &samples[trial % SHIFTS];
        kernels.sample(window.data(), grid, actual);
        for (int i = 0; i < PATCH_SAMPLES; i++)
        {
            const Point place = grid.first + i % PATCH * grid.column + i / PATCH * grid.row;
            const ushort* const columns = &window[(place.y >> 16) * WINDOW_STEP + (place.x >> 16)];
            const int right = (place.x & 65535) / 256, down = (place.y & 65535) / 256;
            const int sum = (schar)columns[0] * (256 - right) * (256 - down) +
                            (schar)(columns[0] >> 8) * (256 - right) * down +
                            (schar)columns[1] * right * (256 - down) +
                            (schar)(columns[1] >> 8) * right * down;
            ASSERT_EQ((int)std::floor(sum / double(1 << (16 - SAMPLE_BITS)) + .5), actual[i])
                    << trial << ", " << i;
        }
    }
}

TEST_F(IIB_RefinementKernels, coarseSums)
{
    const int side = 64, weights[] = {1, 2, 3, 4, 4, 3, 2, 1};
    for (int trial = 0; trial < 50; trial++)
    {
        const std::vector<uchar> first = random<uchar>(side * side, trial == 1 ? 255 : 0, 256),
                                 second = random<uchar>(side * side, 0, trial == 2 ? 1 : 256);
        const Point corner(20 + trial % SHIFTS, 20);
        const auto step = [&] { return integers.between(-131072, 131072); };
        const Point column(step(), step());
        Point rows[COARSE_PIXELS];
        for (Point& row : rows)
            row = Point(step(), step());
        const uchar* const pixels1 = &first[trial % SHIFTS];
        const uchar* const pixels2 = &second[corner.y * side + corner.x];
        const CoarseSums actual = kernels.coarseSums(pixels1, side, pixels2, side, rows, column);
        int a = 0, b = 0, aa = 0, bb = 0, ab = 0, all = 0;
        for (int y = 0; y < COARSE_PIXELS; y++)
            for (int x = 0; x < COARSE_PIXELS; x++)
            {
                const Point place = rows[y] + x * column;
                const int weight = weights[x] * weights[y];
                const int one = pixels1[(COARSE_STEP * y) * side + COARSE_STEP * x] - 128;
                const int other = pixels2[(place.y >> 16) * side + (place.x >> 16)] - 128;
                all += weight;
                a += weight * one;
                b += weight * other;
                aa += weight * one * one;
                bb += weight * other * other;
                ab += weight * one * other;
            }
        EXPECT_EQ(int(CoarseSums::WEIGHTS), all);
        EXPECT_EQ(a, actual.first);
        EXPECT_EQ(b, actual.second);
        EXPECT_EQ(aa, actual.firstSquares);
        EXPECT_EQ(bb, actual.secondSquares);
        EXPECT_EQ(ab, actual.products);
    }
}

TEST_F(IIB_RefinementKernels, squareDifferences)
{
    for (int shift = 0; shift < SHIFTS; shift++)
    {
        const size_t step = TEMPLATE + shift;
        const std::vector<uchar> memory = random<uchar>(TEMPLATE * step + SHIFTS, 0, 256);
        for (ptrdiff_t next : {(ptrdiff_t)1, (ptrdiff_t)step})
        {
            int first = 0, second = 0;
            for (int y = 2; y < TEMPLATE - 1; y += 4)
                for (int x = 1; x < TEMPLATE - 1; x++)
                {
                    const uchar* const p = &memory[shift + y * step + x];
                    const int before = p[0] - p[-next], after = p[next] - p[0];
                    first += after * after;
                    second += (after - before) * (after - before);
                }
            const SquaredDifferences actual = kernels.squareDifferences(&memory[shift], step, next);
            EXPECT_EQ(first, actual.first);
            EXPECT_EQ(second, actual.second);
        }
    }
}

//! The upper half of a product of 16-bit values.
int upperHalf(int a, int b) { return (int)std::floor(a * b / 65536.); }

TEST_F(IIB_RefinementKernels, makeTemplate)
{
    for (int shift = 0; shift < SHIFTS; shift++)
    {
        const PatchWeights weights = randomWeights();
        const size_t step = TEMPLATE + shift;
        const std::vector<uchar> memory = random<uchar>(TEMPLATE * step + SHIFTS, 0, 256);
        const uchar* const pixels = &memory[shift];
        PatchTemplate made;
        kernels.makeTemplate(pixels, step, weights, made);
        for (int i = 0; i < PATCH_SAMPLES; i++)
        {
            const auto at = [&](int dx, int dy) {
                return pixels[(2 * (i / PATCH) + 1 + dy) * step + 2 * (i % PATCH) + 1 + dx];
            };
            const int sample = (at(0, 0) - 128) * (1 << SAMPLE_BITS);
            const int x = (at(1, 0) - at(-1, 0)) * (1 << SAMPLE_BITS) / 2,
                      y = (at(0, 1) - at(0, -1)) * (1 << SAMPLE_BITS) / 2;
            const short w = weights.gaussian[i], wx = weights.gaussianX[i], wy = weights.gaussianY[i];
            const int derivatives[] = {x, y, upperHalf(x, weights.x[i]), upperHalf(x, weights.y[i]),
                    upperHalf(y, weights.x[i]), upperHalf(y, weights.y[i])};
            const int products[] = {upperHalf(sample, w), upperHalf(x, w), upperHalf(y, w), upperHalf(x, wx),
                    upperHalf(x, wy), upperHalf(y, wx), upperHalf(y, wy)};
            ASSERT_EQ(sample, made.samples[i]) << i;
            for (int k = 0; k < PARAMETERS; k++)
                ASSERT_EQ(derivatives[k], made.derivatives[k][i]) << k << ", " << i;
            for (int k = 0; k < SUMS - SUM_TEMPLATE; k++)
                ASSERT_EQ(products[k], made.weights[k][i]) << k << ", " << i;
        }
    }
}

TEST_F(IIB_RefinementKernels, sum_and_sumProducts)
{
    for (int shift = 0; shift < SHIFTS; shift++)
    {
        const PatchWeights weights = randomWeights();
        PatchTemplate patch;
        for (short* const values : patch.derivatives)
            for (int i = 0; i < PATCH_SAMPLES; i++)
                values[i] = (short)integers.between(-4096, 4096);
        for (short* const values : patch.weights)
            for (int i = 0; i < PATCH_SAMPLES; i++)
                values[i] = (short)integers.between(-2048, 2048);
        const std::vector<short> samples = random<short>(PATCH_SAMPLES + SHIFTS, -4096, 4064);
        int sums[SUMS], expected[SUMS] = {}, products[PARAMETERS][PARAMETERS];
        kernels.sum(&samples[shift], weights, patch, sums);
        kernels.sumProducts(patch, products);
        for (int i = 0; i < PATCH_SAMPLES; i++)
        {
            const int sample = samples[shift + i];
            expected[SUM_SAMPLES] += sample * (weights.gaussian[i] >> (15 - WEIGHT_BITS));
            expected[SUM_SQUARES] += sample * upperHalf(sample, weights.gaussian[i]);
            for (int k = SUM_TEMPLATE; k < SUMS; k++)
                expected[k] += sample * patch.weights[k - SUM_TEMPLATE][i];
        }
        for (int k = 0; k < SUMS; k++)
            EXPECT_EQ(expected[k], sums[k]) << k;
        for (int a = 0; a < PARAMETERS; a++)
            for (int b = 0; b <= a; b++)
            {
                int product = 0;
                for (int i = 0; i < PATCH_SAMPLES; i++)
                    product += patch.weights[1 + a][i] * patch.derivatives[b][i];
                EXPECT_EQ(product, products[a][b]) << a << ", " << b;
            }
    }
}

TEST_F(IIB_RefinementKernels, subtract_and_autocorrelate)
{
    for (int shift = 0; shift < SHIFTS; shift++)
    {
        const PatchWeights weights = randomWeights();
        PatchTemplate patch;
        for (short& value : patch.samples)
            value = (short)integers.between(-4096, 4065);
        const std::vector<short> samples = random<short>(PATCH_SAMPLES + SHIFTS, -4096, 4065);
        const int gain = integers.between(1, shift == 0 ? 65536 : 512),
                  offset = integers.between(-9999, 9999);
        std::vector<short> residuals(PATCH_SAMPLES + SHIFTS);
        short* const r = &residuals[SHIFTS - shift];
        kernels.subtract(&samples[shift], weights, patch, gain, offset, r);
        const Autocorrelation sums = kernels.autocorrelate(r);
        int squares = 0, right = 0, below = 0;
        for (int i = 0; i < PATCH_SAMPLES; i++)
        {
            const int residual = samples[shift + i] - cvFloor((gain * patch.samples[i] + offset) / 256.);
            ASSERT_EQ(upperHalf(std::min(std::max(residual, -4095), 4095), weights.gaussian[i]), r[i]) << i;
            squares += r[i] * r[i];
            right += i < PATCH_SAMPLES - PATCH ? r[i] * r[i + 1] : 0;
            below += i < PATCH_SAMPLES - PATCH ? r[i] * r[i + PATCH] : 0;
        }
        EXPECT_EQ(squares, sums.squares);
        EXPECT_EQ(right, sums.right);
        EXPECT_EQ(below, sums.below);
    }
}

}}  // namespace opencv_test
