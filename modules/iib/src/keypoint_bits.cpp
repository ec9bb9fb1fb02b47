// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "keypoint_bits.hpp"

namespace cv {
namespace iib {

namespace {

void widen(const CellGrid<int>& cells, CellGrid<double>& wide)
{
    wide.create(cells.size());
    for (int r = 0; r < cells.size(); r++)
        for (int c = 0; c < cells.size(); c++)
            for (int i = 0; i < GROUP_CHANNELS; i++)
                wide.cell(r, c)[i] = (unsigned)cells.cell(r, c)[i];
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
      levelBits(getLevelBitsFunc(p.mapping)), selectedBits(getSelectedBitsFunc(p.mapping)), parentSums(getParentSumsFunc()), offsets(p.granularity + 1),
      sums(p.granularity + 1), wideSums(p.granularity + 1)
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

void KeyPointBits::writeSelected(int level, const LevelShape& shape, bool wide, uchar* descriptor)
{
    const SelectedQuads& chosen = selection[level];
    if (chosen.places().empty())
        return;
    if (wide)
        wideSelectedBits(mapping, wideSums[level], shape, chosen.places(), chosen.words(), planes.data());
    else
        selectedBits(sums[level], shape, chosen.places(), chosen.words(), planes.data());
    BitWriter out(descriptor, offsets[level]);
    chosen.append(planes.data(), out);
    out.flush();
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
bool KeyPointBits::fitsInt(int maxValue, double longest) const
{
    const double value = 4. * maxValue, area = longest * longest;
    // seldom does the quick bound, with all weights as large as can be, not do
    return value * area * area <= INT_MAX || value * x.largestProduct() * y.largestProduct() <= INT_MAX;
}

void KeyPointBits::write(const int* xEdges, const int* yEdges, double longestCell, int maxValue, bool wide,
                         uchar* descriptor)
{
    x.place(xEdges, size());
    y.place(yEdges, size());
    for (int level = granularity; level >= 1; level--)
    {
        const int n = 1 << level;
        if (level < granularity)
        {
            x.coarsen();
            y.coarsen();
            if (wide)
                wideParentSums(wideSums[level + 1], wideSums[level]);
            else
                parentSums(sums[level + 1], sums[level]);
        }
        if (!wide && !fitsInt(maxValue, longestCell * (size() >> level)))
        {
            widen(sums[level], wideSums[level]);
            wide = true;
        }

        const LevelShape shape = { n, x.lengths, y.lengths, channels, overlap };
        if (!selection.empty())
        {
            writeSelected(level, shape, wide, descriptor);
            continue;
        }
        BitWriter out(descriptor, offsets[level]);
        if (wide)
            wideLevelBits(mapping, wideSums[level], shape, out);
        else
            levelBits(sums[level], shape, out);
        out.flush();
    }
}

}  // namespace iib
}  // namespace cv
