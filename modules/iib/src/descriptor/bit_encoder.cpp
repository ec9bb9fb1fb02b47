// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "bit_encoder.hpp"

namespace cv {
namespace iib {

namespace {

template <typename Cell> void widen(const CellGrid<Cell>& cells, CellGrid<double>& wide)
{
    wide.create(cells.size());
    for (int r = 0; r < cells.size(); r++)
        for (int c = 0; c < cells.size(); c++)
            for (int i = 0; i < GROUP_CHANNELS; i++)
                wide.cell(r, c)[i] = cells.cell(r, c)[i];
}

void wideParentSums(const CellGrid<double>& children, CellGrid<double>& cells)
{
    cells.create(children.size() / 2);
    for (int r = 0; r < cells.size(); r++)
        for (int c = 0; c < cells.size(); c++)
            for (int i = 0; i < GROUP_CHANNELS; i++)
                cells.cell(r, c)[i] =
                        (children.cell(2 * r, 2 * c)[i] + children.cell(2 * r, 2 * c + 1)[i]) +
                        (children.cell(2 * r + 1, 2 * c)[i] + children.cell(2 * r + 1, 2 * c + 1)[i]);
}

//! The largest factor that makes siblings comparable.
double largestWeight(const Axis& axis, int n)
{
    int smallest = INT_MAX, largest = 0;
    for (int i = 0; i < n; i++)
    {
        smallest = std::min(smallest, axis.length(i));
        largest = std::max(largest, axis.length(i));
    }
    return smallest == largest ? 1 : largest;
}

//! Of the channels in use: the others hold nothing.
template <typename Cell> Cell largestSum(const CellGrid<Cell>& cells, int channels)
{
    Cell largest = 0;
    for (int r = 0; r < cells.size(); r++)
        for (int c = 0; c < cells.size(); c++)
            for (int i = 0; i < channels; i++)
                largest = std::max(largest, cells.cell(r, c)[i]);
    return largest;
}

double largestWeight(const LevelShape& shape)
{
    return largestWeight(shape.x, shape.n) * largestWeight(shape.y, shape.n);
}

//! Whether four times the largest weighted sum of a level fits an int, whatever the sums are.
bool alwaysFitsInt(const LevelShape& shape, double value, double longest)
{
    const double area = longest * longest;
    return value * area * area <= INT_MAX || value * area * largestWeight(shape) <= INT_MAX;
}

//! The same for the sums at hand.
template <typename Cell> bool fitsInt(const CellGrid<Cell>& cells, const LevelShape& shape)
{
    return 4. * largestSum(cells, shape.channels) * largestWeight(shape) <= INT_MAX;
}

}  // namespace

BitEncoder::BitEncoder(const Parameters& p, int group, int channels)
    : granularity(finestLevel(p)), mapping(p.mapping), shortKernels(getBitsKernels(p.mapping, ushort())),
      longKernels(getBitsKernels(p.mapping, unsigned())), x(paddedEdges(size())), y(size() + 1),
      chosen(granularity + 1), shapes(granularity + 1), sums(granularity + 1), wideSums(granularity + 1)
{
    sums[0].create(1);
    for (int level = 1; level <= granularity; level++)
    {
        int windows = p.overlap ? (1 << QuadPhase::COUNT) - 1 : 1;
        if (!p.selection.empty())
        {
            windows = 0;
            for (int phase = 0; phase < QuadPhase::COUNT; phase++)
            {
                chosen[level].push_back(ChosenBits(p, level, group, phase));
                windows |= !chosen[level][phase].none() << phase;
            }
        }
        const int step = 1 << (granularity - level);
        const LevelShape shape = {1 << level, bitOffset(p, level, group), {x.data(), step}, {y.data(), step},
                channels, windows, p.selection.empty() ? 0 : chosen[level].data()};
        shapes[level] = shape;
        sums[level].create(shape.n);
    }
}

template <> const BitsKernels<ushort>& BitEncoder::kernels<ushort>() const { return shortKernels; }
template <> const BitsKernels<unsigned>& BitEncoder::kernels<unsigned>() const { return longKernels; }

template <typename Cell>
void BitEncoder::writeFrom(
        int level, const CellGrid<Cell>& cells, double value, double longest, uchar* descriptor)
{
    int coarsest = level + 1;
    for (double l = longest; coarsest > 1 && alwaysFitsInt(shapes[coarsest - 1], value, l); l *= 2)
        coarsest--;
    if (coarsest > level && !fitsInt(cells, shapes[level]))
    {
        widen(cells, wideSums[level]);
        return writeFrom(level, wideSums[level], descriptor);
    }
    coarsest = std::min(coarsest, level);
    kernels<Cell>().levelBits(cells, shapes.data(), level, coarsest, sums.data(), descriptor);
    if (coarsest > 1)
        writeFrom(coarsest - 1, sums[coarsest - 1], value, longest * (2 << (level - coarsest)), descriptor);
}

void BitEncoder::writeFrom(int level, const CellGrid<double>& cells, uchar* descriptor)
{
    BitWriter out(descriptor, shapes[level].offset);
    wideLevelBits(mapping, cells, shapes[level], out);
    out.flush();
    if (level == 1)
        return;
    wideParentSums(cells, wideSums[level - 1]);
    writeFrom(level - 1, wideSums[level - 1], descriptor);
}

template <> void BitEncoder::write<double>(double, int, uchar* descriptor)
{
    writeFrom(granularity, wideSums[granularity], descriptor);
}

template void BitEncoder::writeFrom(int, const CellGrid<ushort>&, double, double, uchar*);
template void BitEncoder::writeFrom(int, const CellGrid<unsigned>&, double, double, uchar*);

}  // namespace iib
}  // namespace cv
