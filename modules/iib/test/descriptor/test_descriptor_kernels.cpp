// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "../support/textures.hpp"

#include "../../src/descriptor/kernels/kernels.hpp"
#include "../../src/descriptor/plan.hpp"

namespace opencv_test { namespace {

using namespace cv::iib;

// Kernels beside naive counterparts.

template <typename T> std::vector<T> randomRow(Integers& random, int width, int limit)
{
    std::vector<T> row(width + ROW_PADDING);
    for (T& v : row)
        v = (T)random.below(limit);
    return row;
}

//! Channels that are added to other rows equal the sum of both.
template <typename T> void checkAddedChannels(int limit)
{
    Integers random(12);
    const RowKernels<T>& kernels = descriptorKernels().pixels(T()).rows;
    for (int width = 1; width <= 140; width++)
    {
        const std::vector<T> above = randomRow<T>(random, width + 2, limit),
                             middle = randomRow<T>(random, width + 2, limit),
                             below = randomRow<T>(random, width + 2, limit);
        const ImageRows<T> rows = {above.data(), middle.data(), below.data()};
        const size_t step = width + ROW_PADDING;
        std::vector<T> alone(6 * step), sums = randomRow<T>(random, 12 * (int)step, 30000);
        const auto planes = [&](T* p) {
            const ImageChannelRows<T> out = {
                    {p, p + step, p + 2 * step, p + 3 * step, p + 4 * step, p + 5 * step}};
            return out;
        };
        kernels.imageChannels(rows, (T)(4 * limit), planes(alone.data()), 0, width);
        T* const added = sums.data() + 6 * step;
        kernels.imageChannels(rows, (T)(4 * limit), planes(added), -6 * (ptrdiff_t)step, width);
        for (int i = 0; i < 6; i++)
            for (int x = 0; x < width; x++)
                ASSERT_EQ((T)(sums[i * step + x] + alone[i * step + x]), added[i * step + x])
                        << "width " << width << " channel " << i << " x " << x;
    }
}

TEST(IIB_DescriptorKernels, channels_added_to_rows)
{
    checkAddedChannels<short>(256);
    checkAddedChannels<int>(65536);
}

TEST(IIB_DescriptorKernels, cell_edges)
{
    Integers random(9);
    for (int n = 2; n <= 64; n *= 2)
        for (int round = 0; round < 50; round++)
        {
            const Rect bounds = round % 2 ? Rect(0, 0, 100, 80) : Rect(-20, -10, 120, 90);
            Point2d corner;
            corner.y = random.below(4800) / 32. - 30;
            corner.x = random.below(4800) / 32. - 30;
            const double side = n + random.below(6400) / 32.;
            CellEdges edges;
            descriptorKernels().cellEdges(corner, side, n, bounds, edges);
            for (int i = 0; i < paddedEdges(n); i++)
            {
                const double k = std::min(i, n), x = std::floor(corner.x + side / n * k + 0.5);
                ASSERT_EQ(std::min(std::max(x, (double)bounds.x), 100.), edges.x[i]);
                if (i <= n)
                {
                    const double y = std::floor(corner.y + side / n * k + 0.5);
                    ASSERT_EQ(std::min(std::max(y, (double)bounds.y), 80.), edges.y[i]);
                }
            }
        }
}

//! Writes the bits of all levels, finest first.
template <typename Sum>
void writeBits(int mapping, const CellGrid<Sum>& cells, const std::vector<LevelShape>& shapes,
        const CellEdges& edges, int level, uchar* descriptor)
{
    if (level == 0)
        return;
    CellGrid<typename BitsKernels<Sum>::Parent> parents;
    descriptorKernels().bits(Sum()).write[mapping](cells, shapes[level], edges, parents, descriptor);
    writeBits(mapping, parents, shapes, edges, level - 1, descriptor);
}

//! The bits of cells with these sums.
template <typename Sum>
std::vector<uchar> bitsOf(int mapping, const std::vector<int>& values, const std::vector<LevelShape>& shapes,
        const CellEdges& edges)
{
    const int finest = (int)shapes.size() - 1, n = 1 << finest;
    CellGrid<Sum> cells;
    cells.create(n);
    for (int r = 0, i = 0; r < n; r++)
        for (int c = 0; c < n; c++)
            for (int channel = 0; channel < GROUP_CHANNELS; channel++)
                cells.cell(r, c)[channel] = (Sum)values[i++];
    std::vector<uchar> descriptor(1 << 20, 0);
    writeBits(mapping, cells, shapes, edges, finest, descriptor.data());
    return descriptor;
}

TEST(IIB_DescriptorKernels, all_types_of_sums_give_the_same_bits)
{
    Integers random(13);
    for (int mapping = 0; mapping < MAPPINGS; mapping++)
        for (int finest = 1; finest <= 6; finest++)
            for (int channels = 1; channels <= GROUP_CHANNELS; channels++)
            {
                const int n = 1 << finest;
                const std::vector<LevelShape> shapes =
                        makePlan({1.f, finest, (1 << channels) - 1, mapping, channels % 2 == 0, 0, 0, 0, {}})
                                ->groups[0]
                                .levels;
                CellEdges edges = CellEdges();
                for (int i = 1; i < paddedEdges(n); i++)
                    edges.x[i] = edges.x[i - 1] + (i <= n ? random.between(1, 3) : 0);
                for (int i = 1; i <= n; i++)
                    edges.y[i] = edges.y[i - 1] + random.between(1, 3);
                std::vector<int> values(n * n * GROUP_CHANNELS);
                for (int& v : values)
                    v = random.below(8);  // ties are frequent
                const std::vector<uchar> bits = bitsOf<double>(mapping, values, shapes, edges);
                EXPECT_NE(0, std::count_if(bits.begin(), bits.end(), [](uchar b) { return b != 0; }));
                EXPECT_EQ(bits, bitsOf<ushort>(mapping, values, shapes, edges));
                EXPECT_EQ(bits, bitsOf<unsigned>(mapping, values, shapes, edges));
            }
}

TEST(IIB_DescriptorKernels, bits_are_written_where_they_belong)
{
    Integers random(10);
    for (int round = 0; round < 300; round++)
    {
        const int offset = random.below(40);
        std::vector<uchar> bytes(200, (uchar)random.below(256)), before = bytes;
        std::vector<int> bits;
        {
            BitWriter out(bytes.data(), offset);
            for (int i = random.below(20); i > 0; i--)
            {
                const int n = random.below(65);
                uint64 word = 0;
                for (int b = 0; b < n; b++)
                {
                    bits.push_back(random.below(2));
                    word |= (uint64)bits.back() << b;
                }
                out.append(word, n);
            }
        }
        for (int i = 0; i < offset; i++)
            ASSERT_EQ(before[i / 8] >> i % 8 & 1, bytes[i / 8] >> i % 8 & 1);
        for (int i = 0; i < (int)bits.size(); i++)
            ASSERT_EQ(bits[i], bytes[(offset + i) / 8] >> (offset + i) % 8 & 1);
        const size_t end = bits.empty() ? (offset + 7) / 8 : (offset + bits.size() + 7) / 8;
        for (size_t i = end; i < bytes.size(); i++)
            ASSERT_EQ(before[i], bytes[i]);
    }
}

}}  // namespace opencv_test
