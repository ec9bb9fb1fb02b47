// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "keypoint_bits.hpp"

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
                cells.cell(r, c)[i] = (children.cell(2 * r, 2 * c)[i] + children.cell(2 * r, 2 * c + 1)[i])
                                      + (children.cell(2 * r + 1, 2 * c)[i] + children.cell(2 * r + 1, 2 * c + 1)[i]);
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

//! Whether four times the largest weighted sum of the level at hand fits an int: by ever dearer bounds.
template <typename Cell>
bool fitsInt(const CellGrid<Cell>& cells, const LevelShape& shape, double value, double longest)
{
    const double area = longest * longest;
    if (value * area * area <= INT_MAX)
        return true;
    const double weight = (double)largestWeight(shape.x, shape.n) * largestWeight(shape.y, shape.n);
    return value * area * weight <= INT_MAX || 4. * largestSum(cells, shape.channels) * weight <= INT_MAX;
}

}  // namespace

KeyPointBits::KeyPointBits(const Parameters& p, int group, int channels_)
    : granularity(finestLevel(p)), mapping(p.mapping), channels(channels_), overlap(p.overlap),
      shortKernels(getBitsKernels(p.mapping, ushort())), longKernels(getBitsKernels(p.mapping, unsigned())),
      offsets(granularity + 1), sums(granularity + 1), wideSums(granularity + 1)
{
    for (int level = 1; level <= granularity; level++)
        offsets[level] = bitOffset(p, level, group);
    if (p.selection.empty())
        return;
    chosen.resize(granularity + 1);
    for (int level = 1; level <= granularity; level++)
        for (int window = 0; window < Window::COUNT; window++)
            chosen[level].push_back(ChosenBits(p, level, group, window));
}

LevelShape KeyPointBits::shapeOf(int level, const int* xEdges, const int* yEdges) const
{
    const int step = 1 << (granularity - level);
    const LevelShape shape = { 1 << level, { xEdges, step }, { yEdges, step }, channels, overlap,
                               chosen.empty() ? 0 : chosen[level].data() };
    return shape;
}

template <> const BitsKernels<ushort>& KeyPointBits::kernels<ushort>() const { return shortKernels; }
template <> const BitsKernels<unsigned>& KeyPointBits::kernels<unsigned>() const { return longKernels; }

template <typename Cell>
void KeyPointBits::writeFrom(int level, const CellGrid<Cell>& cells, const LevelShape& shape, double value,
                             double longest, uchar* descriptor)
{
    if (!fitsInt(cells, shape, value, longest))
    {
        widen(cells, wideSums[level]);
        return writeFrom(level, wideSums[level], shape, value, longest, descriptor);
    }
    BitWriter out(descriptor, offsets[level]);
    kernels<Cell>().levelBits(cells, shape, sums[level - 1], out);
    out.flush();
    if (level > 1)
        writeFrom(level - 1, sums[level - 1], shapeOf(level - 1, shape.x.edges, shape.y.edges), value, 2 * longest,
                  descriptor);
}

void KeyPointBits::writeFrom(int level, const CellGrid<double>& cells, const LevelShape& shape, double value,
                             double longest, uchar* descriptor)
{
    BitWriter out(descriptor, offsets[level]);
    wideLevelBits(mapping, cells, shape, out);
    out.flush();
    if (level == 1)
        return;
    wideParentSums(cells, wideSums[level - 1]);
    writeFrom(level - 1, wideSums[level - 1], shapeOf(level - 1, shape.x.edges, shape.y.edges), value, 2 * longest,
                  descriptor);
}

template void KeyPointBits::writeFrom(int, const CellGrid<ushort>&, const LevelShape&, double, double, uchar*);
template void KeyPointBits::writeFrom(int, const CellGrid<unsigned>&, const LevelShape&, double, double, uchar*);

}  // namespace iib
}  // namespace cv
