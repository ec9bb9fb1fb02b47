// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "layout.hpp"

#include <bitset>

#include "box_plan.hpp"

namespace cv {
namespace iib {

//! Bits of all quads of one channel at a level.
static int channelBits(const Parameters& p, int level)
{
    const int side = p.overlap ? (1 << level) - 1 : 1 << (level - 1);  // quads in a row
    return side * side * bitsPerQuad(p.mapping);
}

//! Bits of a level that the channels before `end` make.
static int bitsBefore(const Parameters& p, int level, int end)
{
    const Mat_<int> selection = p.mapping == IIB::MAPPING_BOXES ? boxSelection(p) : p.selection;
    if (selection.empty())
        return channelBits(p, level) * end;
    int bits = 0;
    for (int i = 0; i < selection.rows; i++)
        if (selection(i, 0) == level && selection(i, 1) < end)
            bits += (int)std::bitset<32>((unsigned)selection(i, 4)).count();
    return bits;
}

int levelBits(const Parameters& p, int level) { return bitsBefore(p, level, p.channelCount()); }

std::vector<int> levelBytes(const Parameters& p)
{
    std::vector<int> bytes;
    for (int level = 1; level <= p.granularity; level++)
        if (const int bits = levelBits(p, level))
            bytes.push_back((bits + 7) / 8);
    return bytes;
}

int finestLevel(const Parameters& p)
{
    return p.selection.empty() ? p.granularity
                               : p.selection(p.selection.rows - 1, 0);  // levels do not descend
}

int bitOffset(const Parameters& p, int level, int group)
{
    int bytes = 0;
    for (int coarser = 1; coarser < level; coarser++)
        bytes += (levelBits(p, coarser) + 7) / 8;
    return 8 * bytes + bitsBefore(p, level, GROUP_CHANNELS * group);
}

}  // namespace iib
}  // namespace cv
