// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "../support/test_images.hpp"

#include "../../src/descriptor/kernels/kernels.hpp"
#include "../../src/descriptor/plan.hpp"

namespace opencv_test {
namespace {

using namespace cv::iib;

// Naive counterparts of the kernels, for this machine's instruction set; ctest pins the others.

template <typename T> std::vector<T> randomRow(Integers& random, int width, int limit)
{
    std::vector<T> row(width + ROW_PADDING);
    for (T& v : row)
        v = (T)random.below(limit);
    return row;
}

//! A row of sums from the row above, for any width and alignment of the planes.
template <typename T, typename Sum> void checkSumRow(int limit)
{
    Integers random(7);
    for (int width = 1; width <= 140; width++)
    {
        const int shift = width % 3;
        std::vector<T> planes[GROUP_CHANNELS];
        const T* begin[GROUP_CHANNELS];
        for (int c = 0; c < GROUP_CHANNELS; c++)
        {
            planes[c] = randomRow<T>(random, width + shift, limit);
            begin[c] = planes[c].data() + shift;
        }
        const size_t values = (size_t)(width + 1 + ROW_PADDING) * GROUP_CHANNELS;
        AlignedBuffer<Sum> above(values + CACHE_LINE), out(values + CACHE_LINE);
        Sum* const a = above.data() + CACHE_LINE / sizeof(Sum) - GROUP_CHANNELS;
        Sum* const o = out.data() + CACHE_LINE / sizeof(Sum) - GROUP_CHANNELS;
        for (size_t i = 0; i < values; i++)
            a[i] = i < GROUP_CHANNELS ? 0 : (Sum)random.below(INT_MAX);
        descriptorKernels().sumRow(T(), Sum())(begin, width, a, o);
        for (int c = 0; c < GROUP_CHANNELS; c++)
        {
            Sum sum = 0;
            for (int x = 1; x <= width; x++)
            {
                sum = (Sum)(sum + begin[c][x - 1]);
                ASSERT_EQ((Sum)(a[x * GROUP_CHANNELS + c] + sum), o[x * GROUP_CHANNELS + c])
                        << "width " << width << " x " << x;
            }
        }
    }
}

TEST(IIB_DescriptorKernels, integral_rows)
{
    checkSumRow<short, ushort>(2041);
    checkSumRow<short, unsigned>(2041);
    checkSumRow<int, unsigned>(524281);
}

//! Integral rows in a ring, as the band makes them, of a random map of four channels.
template <typename Sum> struct Ring
{
    Mat_<Vec4i> map;
    std::vector<Sum> values;
    RingRows<Sum> rows;

    Ring(Rect area, int count, int end, int limit, Integers& random) : map(area.size())
    {
        for (Vec4i& v : map)
            for (int c = 0; c < 4; c++)
                v[c] = random.below(limit);
        rows.step = (size_t)(area.width + 1 + ROW_PADDING) * GROUP_CHANNELS;
        rows.count = count;
        rows.origin = area.tl();
        values.assign(rows.step * count, 0);
        for (int y = std::max(0, end - count + 1); y <= end; y++)
            for (int x = 0; x <= area.width; x++)
                for (int c = 0; c < 4; c++)
                    values[y % count * rows.step + x * 4 + c] = sum(0, 0, x, y, c);
        rows.data = values.data();
    }

    Sum sum(int x0, int y0, int x1, int y1, int c) const
    {
        Sum total = 0;
        for (int y = y0; y < y1; y++)
            for (int x = x0; x < x1; x++)
                total = (Sum)(total + map(y, x)[c]);
        return total;
    }

    //! Cells between edges; further channels repeat the last.
    void expectCells(const CellGrid<Sum>& cells, const std::vector<int>& x, const std::vector<int>& y, int n,
            int channels = GROUP_CHANNELS) const
    {
        const Point o = rows.origin;
        for (int r = 0; r < n; r++)
            for (int c = 0; c < n; c++)
                for (int i = 0; i < GROUP_CHANNELS; i++)
                    ASSERT_EQ(sum(x[c] - o.x, y[r] - o.y, x[c + 1] - o.x, y[r + 1] - o.y,
                                      std::min(i, channels - 1)),
                            cells.cell(r, c)[i])
                            << n << ": " << r << ", " << c;
    }
};

template <typename Sum> void checkCells(int limit)
{
    Integers random(8);
    const Rect area(11, 5, 90, 70);
    const Ring<Sum> ring(area, 66, 64, limit, random);
    for (int n = 2; n <= 64; n *= 2)
        for (int round = 0; round < 4; round++)
        {
            std::vector<int> x(n + 1), y(n + 1);
            for (int i = 0; i <= n; i++)
            {
                x[i] = area.x + random.below(area.width + 1);
                y[i] = area.y + random.below(65);
            }
            std::sort(x.begin(), x.end());
            std::sort(y.begin(), y.end());
            x.resize(paddedEdges(n), x[n]);
            CellGrid<Sum> cells;
            descriptorKernels().cells(Sum())(ring.rows, x.data(), y.data(), n, cells);
            CellGrid<unsigned> parents;
            descriptorKernels().bits(Sum()).parentSums(cells, parents);
            ring.expectCells(cells, x, y, n);
            for (int r = 0; r < n / 2; r++)
                for (int c = 0; c < n / 2; c++)
                    for (int i = 0; i < 4; i++)
                        ASSERT_EQ((unsigned)cells.cell(2 * r, 2 * c)[i] + cells.cell(2 * r, 2 * c + 1)[i] +
                                          cells.cell(2 * r + 1, 2 * c)[i] +
                                          cells.cell(2 * r + 1, 2 * c + 1)[i],
                                parents.cell(r, c)[i])
                                << n << ": " << r << ", " << c;
        }
}

TEST(IIB_DescriptorKernels, cell_sums)
{
    checkCells<ushort>(60);
    checkCells<unsigned>(1 << 20);
}

//! From sums down the columns of as many channels, where the kernel exists.
void checkColumnCells(int channels, int widest)
{
    Integers random(11);
    const Rect area(11, 5, 330, 70);
    const Ring<ushort> ring(area, 66, 64, 60, random);
    const size_t plane = (size_t)area.width + ROW_PADDING;
    std::vector<short> values(GROUP_CHANNELS * plane * ring.rows.count);
    const RingRows<short> rows = {values.data(), GROUP_CHANNELS * plane, ring.rows.count, ring.rows.origin};
    size_t places[GROUP_CHANNELS];
    for (int i = 0; i < GROUP_CHANNELS; i++)
        places[i] = std::min(i, channels - 1) * plane;
    for (int y = 0; y < rows.count; y++)
        for (int i = 0; i < GROUP_CHANNELS; i++)
            for (int x = 0; x < area.width; x++)
                values[y * rows.step + i * plane + x] = (short)(60000 + ring.sum(x, 0, x + 1, y, i));
    for (int n = 8; n <= 64; n *= 2)
        for (int round = 0; round < 5; round++)
        {
            std::vector<int> x(1, area.x + random.below(10)), y(n + 1);
            for (int i = 0; i < n; i++)
                x.push_back(x[i] + std::max(0, widest - random.below(3)));
            for (int& v : y)
                v = area.y + random.below(65);
            std::sort(y.begin(), y.end());
            x.resize(paddedEdges(n), x[n]);
            CellGrid<ushort> cells;
            descriptorKernels().columnCells(rows, places, x.data(), y.data(), n, cells);
            ring.expectCells(cells, x, y, n, channels);
        }
}

TEST(IIB_DescriptorKernels, cell_sums_from_columns)
{
    if (!descriptorKernels().columnCells)
        throw SkipTestException("these instructions have no such kernel");
    for (int channels = 1; channels <= GROUP_CHANNELS; channels++)
        for (int widest = 0; widest <= 5; widest++)
            checkColumnCells(channels, widest);
}

//! Channels added to other rows are what they are alone, and those rows.
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
                    p, p + step, p + 2 * step, p + 3 * step, p + 4 * step, p + 5 * step};
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
            const Point2d corner(random.below(4800) / 32. - 30, random.below(4800) / 32. - 30);
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

//! Of all levels, finest first.
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

//! Of random cells; sums that fit both kinds of kernels.
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
                const int n = 1 << finest, phases = channels % 2 ? 1 : 15;
                std::vector<LevelShape> shapes(1);
                for (int level = 1, offset = 0; level <= finest; level++)
                {
                    shapes.push_back(LevelShape{1 << level, 1 << (finest - level), offset, channels, phases,
                            std::vector<ChosenBits>()});
                    offset += 8 * 4 * channels << 2 * level;
                }
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

}  // namespace
}  // namespace opencv_test
