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
      levelBits(getLevelBitsFunc(p.mapping)), parentSums(getParentSumsFunc()), offsets(p.granularity + 1),
      sums(p.granularity + 1), wideSums(p.granularity + 1), widths(size()), heights(size())
{
    for (int level = 1; level <= granularity; level++)
        offsets[level] = bitOffset(p, level, group);
}

//! The lengths of a level's cells along one axis; returns the largest.
int KeyPointBits::measure(int level, const int* edges, std::vector<int>& lengths, bool& equal) const
{
    const int step = 1 << (granularity - level);
    int largest = 0;
    equal = true;
    for (int i = 0; i < 1 << level; i++)
    {
        lengths[i] = edges[(i + 1) * step] - edges[i * step];
        equal = equal && lengths[i] == lengths[0];
        largest = std::max(largest, lengths[i]);
    }
    return largest;
}

//! Measures a level's cells; whether four times each weighted sum fits an int.
bool KeyPointBits::fits(int level, const int* xEdges, const int* yEdges, int maxValue)
{
    bool equalWidths, equalHeights;
    const double width = measure(level, xEdges, widths, equalWidths);
    const double height = measure(level, yEdges, heights, equalHeights);
    return 4. * maxValue * width * height * (equalWidths ? 1 : width) * (equalHeights ? 1 : height) <= INT_MAX;
}

void KeyPointBits::write(const int* xEdges, const int* yEdges, int maxValue, bool wide, uchar* descriptor)
{
    for (int level = granularity; level >= 1; level--)
    {
        const bool tooLarge = !fits(level, xEdges, yEdges, maxValue);
        if (level < granularity && wide)
            wideParentSums(wideSums[level + 1], wideSums[level]);
        else if (level < granularity)
            parentSums(sums[level + 1], sums[level]);
        if (tooLarge && !wide)
            widen(sums[level], wideSums[level]);
        wide = wide || tooLarge;

        const LevelShape shape = { 1 << level, widths.data(), heights.data(), channels, overlap };
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
