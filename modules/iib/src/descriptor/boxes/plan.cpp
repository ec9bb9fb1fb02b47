// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "plan.hpp"

namespace cv {
namespace iib {

namespace {

//! Of a channel's kind.
int laneOf(int kind)
{
    switch (kind)
    {
    case IIB::CHANNEL_GRAD_X: return LANE_ABSOLUTE_X;
    case IIB::CHANNEL_GRAD_Y: return LANE_ABSOLUTE_Y;
    case IIB::CHANNEL_SIGNED_GRAD_X: return LANE_GRADIENT_X;
    case IIB::CHANNEL_SIGNED_GRAD_Y: return LANE_GRADIENT_Y;
    default: return LANE_INTENSITY;
    }
}

//! Which comparisons are chosen, where they lie in memory.
ChosenBits chosenOf(const Parameters& p, int level, const BoxGridShape& shape)
{
    std::vector<uint64> masks((shape.comparisonBytes() + 7) / 8, 0);
    const auto choose = [&](int byte, int lane) { masks[byte / 8] |= (uint64)1 << (8 * (byte % 8) + lane); };
    const auto add = [&](int kind, int row, int col, int mask) {
        const int lane = laneOf(kind);
        for (int bit = 0; bit < BOX_HAAR_BITS; bit++)
            if (mask >> bit & 1)
                choose((BOX_HAAR_BITS * row + bit) * shape.quadBytes() + col, lane);
        const int own = BOX_HAAR_BITS * (shape.n - 1) * shape.quadBytes() + row * shape.stride() + col;
        if (mask & BOX_FIRST_OWN_BIT)
            choose(own, lane == LANE_GRADIENT_X ? (int)LANE_GRADIENT_X_AGAIN : lane);
        if (mask & BOX_SECOND_OWN_BIT)
            choose(own, lane == LANE_GRADIENT_Y ? (int)LANE_GRADIENT_SUM : lane);
    };
    const std::vector<int> kinds = p.channelKinds();
    for (int i = 0; i < p.selection.rows; i++)
        if (p.selection(i, 0) == level)
            add(kinds[p.selection(i, 1)], p.selection(i, 2), p.selection(i, 3), p.selection(i, 4));
    if (p.selection.empty())
        for (int kind : kinds)
            for (int row = 0; row < shape.n; row++)
                for (int col = 0; col < shape.n; col++)
                    add(kind, row, col, boxMask(kind, level, row, col));
    return ChosenBits(masks);
}

}  // namespace

BoxPlan makeBoxPlan(const Parameters& p)
{
    BoxPlan plan;
    int places = 0;
    for (int level = 1; level <= p.granularity; level++)
    {
        const BoxGrid& grid = BOX_GRIDS[level - 1];
        const BoxGridShape shape = {grid.n, places};
        BoxPlan::Level l = {shape, grid.side / 80., {}, bitOffset(p, level, 0), chosenOf(p, level, shape)};
        if (l.chosen.none())
            continue;
        for (int i = 0; i < grid.n; i++)
        {
            l.centres.push_back(grid.centre(i));
            plan.edges[0][places] = grid.edge(i, -1);
            plan.edges[1][places++] = grid.edge(i, 1);
        }
        plan.levels.push_back(l);
    }
    return plan;
}

}  // namespace iib
}  // namespace cv
