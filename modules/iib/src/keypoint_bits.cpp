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

//! The largest length, times the largest factor that makes siblings comparable.
double largestProduct(const Axis& axis, int n)
{
    int smallest = INT_MAX, largest = 0;
    for (int i = 0; i < n; i++)
    {
        smallest = std::min(smallest, axis.length(i));
        largest = std::max(largest, axis.length(i));
    }
    return smallest == largest ? largest : (double)largest * largest;
}

//! Whether four times the largest weighted sum of the level at hand fits an int.
bool fitsInt(const LevelShape& shape, double value, double longest)
{
    const double area = longest * longest;
    // seldom does the quick bound, with all weights as large as can be, not do
    return value * area * area <= INT_MAX
           || value * largestProduct(shape.x, shape.n) * largestProduct(shape.y, shape.n) <= INT_MAX;
}

LevelShape coarser(const LevelShape& shape)
{
    LevelShape c = shape;
    c.n /= 2;
    c.x.step *= 2;
    c.y.step *= 2;
    return c;
}

}  // namespace

KeyPointBits::KeyPointBits(const Parameters& p, int group, int channels_)
    : granularity(p.granularity), mapping(p.mapping), channels(channels_), overlap(p.overlap),
      shortKernels(getBitsKernels(p.mapping, ushort())), longKernels(getBitsKernels(p.mapping, unsigned())),
      offsets(p.granularity + 1), sums(p.granularity + 1), wideSums(p.granularity + 1)
{
    for (int level = 1; level <= granularity; level++)
        offsets[level] = bitOffset(p, level, group);
    if (p.selection.empty())
        return;
    selection.resize(granularity + 1);
    size_t words = 0;
    for (int level = 1; level <= granularity; level++)
    {
        selection[level] = SelectedQuads(p, level, group);
        words = std::max(words, (size_t)selection[level].words());
    }
    planes.resize(words * bitsPerQuad(mapping));
}

template <> const BitsKernels<ushort>& KeyPointBits::kernels<ushort>() const { return shortKernels; }
template <> const BitsKernels<unsigned>& KeyPointBits::kernels<unsigned>() const { return longKernels; }

template <typename Cell>
void KeyPointBits::writeFrom(int level, const CellGrid<Cell>& cells, const LevelShape& shape, double value,
                             double longest, uchar* descriptor)
{
    if (!fitsInt(shape, value, longest))
    {
        widen(cells, wideSums[level]);
        return writeFrom(level, wideSums[level], shape, value, longest, descriptor);
    }
    const BitsKernels<Cell>& k = kernels<Cell>();
    BitWriter out(descriptor, offsets[level]);
    if (selection.empty())
        k.levelBits(cells, shape, sums[level - 1], out);
    else
    {
        const SelectedQuads& chosen = selection[level];
        k.selectedBits(cells, shape, chosen.places(), chosen.words(), planes.data());
        chosen.append(planes.data(), out);
        k.parentSums(cells, sums[level - 1]);
    }
    out.flush();
    if (level == 1)
        return;
    writeFrom(level - 1, sums[level - 1], coarser(shape), value, 2 * longest, descriptor);
}

void KeyPointBits::writeFrom(int level, const CellGrid<double>& cells, const LevelShape& shape, double value,
                             double longest, uchar* descriptor)
{
    BitWriter out(descriptor, offsets[level]);
    if (selection.empty())
        wideLevelBits(mapping, cells, shape, out);
    else
    {
        const SelectedQuads& chosen = selection[level];
        wideSelectedBits(mapping, cells, shape, chosen.places(), chosen.words(), planes.data());
        chosen.append(planes.data(), out);
    }
    out.flush();
    if (level == 1)
        return;
    wideParentSums(cells, wideSums[level - 1]);
    writeFrom(level - 1, wideSums[level - 1], coarser(shape), value, 2 * longest, descriptor);
}

template void KeyPointBits::writeFrom(int, const CellGrid<ushort>&, const LevelShape&, double, double, uchar*);
template void KeyPointBits::writeFrom(int, const CellGrid<unsigned>&, const LevelShape&, double, double, uchar*);

}  // namespace iib
}  // namespace cv
