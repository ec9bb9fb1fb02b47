// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "box_plan.hpp"

#include <map>

#include "layout.hpp"

namespace cv {
namespace iib {

namespace {

enum
{
    HAAR_BITS = 3,
    HAAR_MASK = (1 << HAAR_BITS) - 1,
    FIRST_OWN_BIT = 1 << HAAR_BITS,
    SECOND_OWN_BIT = FIRST_OWN_BIT << 1,
    LANES_OF_OWN_BITS = 4
};

//! The lane of a channel in use.
int laneOf(const Parameters& p, int channel)
{
    const struct
    {
        int kind, lane;
    } lanes[] = {{IIB::CHANNEL_GRAD_X, LANE_ABSOLUTE_X}, {IIB::CHANNEL_GRAD_Y, LANE_ABSOLUTE_Y},
            {IIB::CHANNEL_INTENSITY, LANE_INTENSITY}, {IIB::CHANNEL_SIGNED_GRAD_X, LANE_GRADIENT_X},
            {IIB::CHANNEL_SIGNED_GRAD_Y, LANE_GRADIENT_Y}};
    for (const auto& l : lanes)
        if ((p.channels & l.kind) && channel-- == 0)
            return l.lane;
    CV_Error(Error::StsInternal, "no such channel");
}

//! The comparisons of a level, of all those with chosen bits in order.
BoxComparisons comparisonsOf(
        const Parameters& p, const Mat_<int>& selection, int level, const std::vector<int>& boxes)
{
    const int n = BOX_GRIDS[level - 1].n;
    typedef std::map<int, unsigned> LanesOfPlaces;  // place in the grid
    LanesOfPlaces quads[HAAR_BITS], own;
    for (int i = 0; i < selection.rows; i++)
    {
        const int* const row = selection[i];
        const int place = row[2] * n + row[3], mask = row[4], lane = laneOf(p, row[1]);
        if (row[0] != level)
            continue;
        for (int bit = 0; (mask & HAAR_MASK) && bit < HAAR_BITS; bit++)
            quads[bit][place] |= (unsigned)(mask >> bit & 1) << lane;
        if (mask & FIRST_OWN_BIT)
            own[place] |= 1u << lane;
        if (mask & SECOND_OWN_BIT)
            own[place] |= 1u << (LANES_OF_OWN_BITS + lane);
    }

    std::vector<uchar> bytes;
    BoxComparisons result = {bitOffset(p, level, 0), {}, {}, ChosenBits(std::vector<uint64>())};
    for (const auto& quad : quads[0])
    {
        const int place = quad.first;
        const BoxComparisons::Quad q = {{(ushort)boxes[place], (ushort)boxes[place + 1],
                (ushort)boxes[place + n], (ushort)boxes[place + n + 1]}};
        result.quads.push_back(q);
        for (int bit = 0; bit < HAAR_BITS; bit++)
            bytes.push_back((uchar)quads[bit][place]);
    }
    for (const auto& box : own)
    {
        result.boxes.push_back((ushort)boxes[box.first]);
        bytes.push_back((uchar)box.second);
    }
    std::vector<uint64> masks((bytes.size() + 7) / 8, 0);
    for (size_t i = 0; i < bytes.size(); i++)
        masks[i / 8] |= (uint64)bytes[i] << 8 * (i % 8);
    result.chosen = ChosenBits(masks);
    return result;
}

}  // namespace

int boxMask(const Parameters& p, int level, int channel, int row, int col)
{
    const int last = BOX_GRIDS[level - 1].n - 1;
    int mask = row < last && col < last ? (int)HAAR_MASK : 0;
    switch (laneOf(p, channel))
    {
    case LANE_GRADIENT_X:
    case LANE_GRADIENT_Y: return mask | FIRST_OWN_BIT | SECOND_OWN_BIT;
    case LANE_ABSOLUTE_X: return mask | FIRST_OWN_BIT;
    default: return mask;
    }
}

Mat_<int> boxSelection(const Parameters& p)
{
    if (!p.selection.empty())
        return p.selection;
    Mat_<int> all(0, 5);
    for (int level = 1; level <= p.granularity; level++)
        for (int channel = 0; channel < p.channelCount(); channel++)
            for (int row = 0; row < BOX_GRIDS[level - 1].n; row++)
                for (int col = 0; col < BOX_GRIDS[level - 1].n; col++)
                    if (const int mask = boxMask(p, level, channel, row, col))
                        all.push_back(Mat_<int>({level, channel, row, col, mask}).reshape(1, 1));
    return all;
}

BoxPlan::BoxPlan(const Parameters& p)
{
    const Mat_<int> selection = boxSelection(p);
    for (int level = 1; level <= p.granularity; level++)
    {
        const BoxGrid& grid = BOX_GRIDS[level - 1];
        std::vector<bool> used(grid.n * grid.n);
        for (int i = 0; i < selection.rows; i++)
        {
            const int place = selection(i, 2) * grid.n + selection(i, 3);
            if (selection(i, 0) == level && (selection(i, 4) & HAAR_MASK))
                used[place + 1] = used[place + grid.n] = used[place + grid.n + 1] = true;
            if (selection(i, 0) == level)
                used[place] = true;
        }
        Level l = {grid.side, boxes(), 0, {0, {}, {}, ChosenBits(std::vector<uint64>())}};
        std::vector<int> indices(used.size());
        for (size_t place = 0; place < used.size(); place++)
            if (used[place])
            {
                indices[place] = boxes();
                x.push_back(grid.centre((int)place % grid.n));
                y.push_back(grid.centre((int)place / grid.n));
            }
        l.end = boxes();
        if (l.end == l.first)
            continue;
        l.comparisons = comparisonsOf(p, selection, level, indices);
        levels.push_back(l);
    }
}

}  // namespace iib
}  // namespace cv
