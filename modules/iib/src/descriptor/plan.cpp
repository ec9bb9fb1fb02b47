// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "plan.hpp"

namespace cv { namespace iib {

//! The bits in use of a phase of a level. @param group number of the group of four channels.
static ChosenBits chosenBits(const Parameters& p, int level, int group, int index)
{
    const QuadPhase phase(1 << level, index);
    const int planes = bitsPerQuad(p.mapping), planeBits = 8 * phase.planeBytes();
    std::vector<uint64> masks((phase.rows * planes * planeBits + 63) / 64, 0);
    forEachPlace(p, level, [&](int channel, int row, int col, int bits) {
        if (channel / GROUP_CHANNELS != group || row % 2 != phase.dy || col % 2 != phase.dx)
            return;
        for (int plane = 0; plane < planes; plane++)
        {
            const int bit = (row / 2 * planes + plane) * planeBits + col / 2 * GROUP_CHANNELS +
                            channel % GROUP_CHANNELS;
            masks[bit / 64] |= (uint64)(bits >> plane & 1) << bit % 64;
        }
    });
    return ChosenBits(masks);
}

//! Adds a level to the groups of channels, at this bit of the descriptor. @return its number of bits.
static int addQuads(const Parameters& p, int finest, int level, int offset, std::vector<ChannelGroup>& groups)
{
    int bits = 0;
    for (ChannelGroup& group : groups)
    {
        LevelShape shape = {1 << level, 1 << (finest - level), offset + bits, {}};
        for (int phase = 0; phase < QuadPhase::COUNT; phase++)
        {
            shape.chosen.push_back(chosenBits(p, level, group.first / GROUP_CHANNELS, phase));
            bits += shape.chosen.back().count();
        }
        group.levels.push_back(shape);
    }
    return bits;
}

static int laneOf(int kind)
{
    const int lanes[IMAGE_PLANES] = {
            LANE_ABSOLUTE_X, LANE_ABSOLUTE_Y, -1, LANE_INTENSITY, LANE_GRADIENT_X, LANE_GRADIENT_Y};
    return lanes[planeOf(kind)];
}

//! The comparisons in use of a level of boxes.
static ChosenBits chosenOf(const Parameters& p, int level, const BoxGridShape& shape)
{
    std::vector<uint64> masks((shape.comparisonBytes() + 7) / 8, 0);
    const auto choose = [&](int byte, int lane) { masks[byte / 8] |= (uint64)1 << (8 * (byte % 8) + lane); };
    const std::vector<int> kinds = p.channelKinds();
    forEachPlace(p, level, [&](int channel, int row, int col, int mask) {
        const int lane = laneOf(kinds[channel]);
        for (int bit = 0; bit < BOX_HAAR_BITS; bit++)
            if (mask >> bit & 1)
                choose((BOX_HAAR_BITS * row + bit) * shape.quadBytes() + col, lane);
        const int own = BOX_HAAR_BITS * (shape.n - 1) * shape.quadBytes() + row * shape.stride() + col;
        if (mask & BOX_FIRST_OWN_BIT)
            choose(own, lane == LANE_GRADIENT_X ? (int)LANE_GRADIENT_X_AGAIN : lane);
        if (mask & BOX_SECOND_OWN_BIT)
            choose(own, lane == LANE_GRADIENT_Y ? (int)LANE_GRADIENT_SUM : lane);
    });
    return ChosenBits(masks);
}

//! addQuads() for boxes.
static int addBoxes(const Parameters& p, int level, int offset, BoxPlan& plan)
{
    const BoxGrid& grid = BOX_GRIDS[level - 1];
    int place = plan.levels.empty() ? 0 : plan.levels.back().shape.first + plan.levels.back().shape.n;
    const BoxGridShape shape = {grid.n, place};
    BoxPlan::Level l = {shape, grid.side / 80., {}, offset, chosenOf(p, level, shape)};
    if (l.chosen.none())
        return 0;
    for (int i = 0; i < grid.n; i++, place++)
    {
        l.centres.push_back(grid.centre(i));
        plan.edges[0][place] = grid.edge(i, -1);
        plan.edges[1][place] = grid.edge(i, 1);
    }
    plan.levels.push_back(l);
    return l.chosen.count();
}

Ptr<const DescriptorPlan> makePlan(const Parameters& p)
{
    const Mat_<int>& s = p.selection;  // levels do not descend
    DescriptorPlan plan = {
            p, s.empty() ? p.granularity : s(s.rows - 1, 0), {}, 0, {}, BoxPlan(), descriptorKernels()};
    const int channels = p.channelCount();
    for (int first = 0; first < channels && !plan.isOfBoxes(); first += GROUP_CHANNELS)
        plan.groups.push_back(
                {first, std::min(channels - first, GROUP_CHANNELS), std::vector<LevelShape>(1)});
    for (int level = 1; level <= plan.finest; level++)
    {
        const int offset = 8 * plan.bytes;
        const int bits = plan.isOfBoxes() ? addBoxes(p, level, offset, plan.boxes)
                                          : addQuads(p, plan.finest, level, offset, plan.groups);
        if (bits == 0)
            continue;
        plan.levelBytes.push_back((bits + 7) / 8);
        plan.bytes += plan.levelBytes.back();
    }
    return makePtr<const DescriptorPlan>(plan);
}

}}  // namespace cv::iib
