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

void KeyPointBits::Axis::place(const int* edges, int n_)
{
    n = n_;
    for (int i = 0; i < n; i++)
        lengths[i] = edges[i + 1] - edges[i];
}

void KeyPointBits::Axis::coarsen()
{
    n /= 2;
    for (int i = 0; i < n; i++)
        lengths[i] = lengths[2 * i] + lengths[2 * i + 1];
}

double KeyPointBits::Axis::largestProduct() const
{
    const int smallest = *std::min_element(lengths, lengths + n);
    const double largest = *std::max_element(lengths, lengths + n);
    return smallest == largest ? largest : largest * largest;
}

//! Whether four times the largest weighted sum of the level at hand fits an int.
bool KeyPointBits::fitsInt(double value, double longest) const
{
    const double area = longest * longest;
    // seldom does the quick bound, with all weights as large as can be, not do
    return value * area * area <= INT_MAX || value * x.largestProduct() * y.largestProduct() <= INT_MAX;
}

LevelShape KeyPointBits::shape() const
{
    const LevelShape s = { x.n, x.lengths, y.lengths, channels, overlap };
    return s;
}

template <> const BitsKernels<ushort>& KeyPointBits::kernels<ushort>() const { return shortKernels; }
template <> const BitsKernels<unsigned>& KeyPointBits::kernels<unsigned>() const { return longKernels; }

template <typename Cell>
void KeyPointBits::writeFrom(int level, const CellGrid<Cell>& cells, double value, double longest, uchar* descriptor)
{
    if (!fitsInt(value, longest))
    {
        widen(cells, wideSums[level]);
        return writeFrom(level, wideSums[level], value, longest, descriptor);
    }
    const BitsKernels<Cell>& k = kernels<Cell>();
    BitWriter out(descriptor, offsets[level]);
    if (selection.empty())
        k.levelBits(cells, shape(), sums[level - 1], out);
    else
    {
        const SelectedQuads& chosen = selection[level];
        k.selectedBits(cells, shape(), chosen.places(), chosen.words(), planes.data());
        chosen.append(planes.data(), out);
        k.parentSums(cells, sums[level - 1]);
    }
    out.flush();
    if (level == 1)
        return;
    x.coarsen();
    y.coarsen();
    writeFrom(level - 1, sums[level - 1], value, 2 * longest, descriptor);
}

void KeyPointBits::writeFrom(int level, const CellGrid<double>& cells, double value, double longest, uchar* descriptor)
{
    BitWriter out(descriptor, offsets[level]);
    if (selection.empty())
        wideLevelBits(mapping, cells, shape(), out);
    else
    {
        const SelectedQuads& chosen = selection[level];
        wideSelectedBits(mapping, cells, shape(), chosen.places(), chosen.words(), planes.data());
        chosen.append(planes.data(), out);
    }
    out.flush();
    if (level == 1)
        return;
    x.coarsen();
    y.coarsen();
    wideParentSums(cells, wideSums[level - 1]);
    writeFrom(level - 1, wideSums[level - 1], value, 2 * longest, descriptor);
}

template void KeyPointBits::writeFrom(int, const CellGrid<ushort>&, double, double, uchar*);
template void KeyPointBits::writeFrom(int, const CellGrid<unsigned>&, double, double, uchar*);

}  // namespace iib
}  // namespace cv
