// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "box_plan.hpp"

#include "layout.hpp"

namespace cv {
namespace iib {

namespace {

enum
{
    HAAR_BITS = 3,
    HAAR_MASK = (1 << HAAR_BITS) - 1,
    FIRST_OWN_BIT = 1 << HAAR_BITS,
    SECOND_OWN_BIT = FIRST_OWN_BIT << 1
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

//! Marks the bits that are chosen where their comparisons lie in memory.
ChosenBits chosenOf(const Mat_<int>& selection, const Parameters& p, int level, const BoxGridShape& shape)
{
    std::vector<uint64> masks((shape.comparisonBytes() + 7) / 8, 0);
    const auto choose = [&](int byte, int lane) { masks[byte / 8] |= (uint64)1 << (8 * (byte % 8) + lane); };
    for (int i = 0; i < selection.rows; i++)
    {
        const int* const row = selection[i];
        if (row[0] != level)
            continue;
        const int lane = laneOf(p, row[1]), mask = row[4];
        for (int bit = 0; bit < HAAR_BITS; bit++)
            if (mask >> bit & 1)
                choose((HAAR_BITS * row[2] + bit) * shape.quadBytes() + row[3], lane);
        const int own = HAAR_BITS * (shape.n - 1) * shape.quadBytes() + row[2] * shape.stride() + row[3];
        if (mask & FIRST_OWN_BIT)
            choose(own, lane == LANE_GRADIENT_X ? (int)LANE_GRADIENT_X_AGAIN : lane);
        if (mask & SECOND_OWN_BIT)
            choose(own, lane == LANE_GRADIENT_Y ? (int)LANE_GRADIENT_SUM : lane);
    }
    return ChosenBits(masks);
}

//! How many boxes on another one begins where it ends; n if there is none.
int spanOf(const BoxGrid& grid)
{
    int span = 1;
    while (span < grid.n && grid.edge(span, -1) != grid.edge(0, 1))
        span++;
    return span;
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

BoxPlan::BoxPlan(const Parameters& p) : edges()
{
    const Mat_<int> selection = boxSelection(p);
    int places = 0;
    for (int level = 1; level <= p.granularity; level++)
    {
        const BoxGrid& grid = BOX_GRIDS[level - 1];
        const BoxGridShape shape = {grid.n, spanOf(grid), places};
        Level l = {shape, grid.side / 80., {}, bitOffset(p, level, 0), chosenOf(selection, p, level, shape)};
        if (l.chosen.none())
            continue;
        for (int i = 0; i < grid.n; i++)
        {
            l.centres.push_back(grid.centre(i));
            edges[0][places] = grid.edge(i, -1);
            edges[1][places++] = grid.edge(i, 1);
        }
        levels.push_back(l);
    }
}

}  // namespace iib
}  // namespace cv
