// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "plan.hpp"

#include <numeric>

namespace cv {
namespace iib {

//! The bits of a phase of a level that are in use. @param group which four of the channels.
static ChosenBits chosenBits(const Parameters& p, int level, int group, int index)
{
    const QuadPhase phase(1 << level, index);
    const int planes = bitsPerQuad(p.mapping), planeBits = 8 * phase.planeBytes();
    std::vector<uint64> masks((phase.rows * planes * planeBits + 63) / 64, 0);
    const auto choose = [&](int row, int col, int channel, int bits) {
        for (int plane = 0; plane < planes; plane++)
        {
            const int bit = (row * planes + plane) * planeBits + col * GROUP_CHANNELS + channel;
            masks[bit / 64] |= (uint64)(bits >> plane & 1) << bit % 64;
        }
    };
    for (int i = 0; i < p.selection.rows; i++)
    {
        const int* quad = p.selection[i];
        const int channel = quad[1], row = quad[2], col = quad[3];
        if (quad[0] == level && channel / GROUP_CHANNELS == group && row % 2 == phase.dy &&
                col % 2 == phase.dx)
            choose(row / 2, col / 2, channel % GROUP_CHANNELS, quad[4]);
    }
    const bool all = p.selection.empty() && (index == 0 || p.overlap);
    const int channels = all ? std::min(p.channelCount() - group * GROUP_CHANNELS, GROUP_CHANNELS) : 0;
    for (int row = 0; row < phase.rows; row++)
        for (int col = 0; col < phase.quads; col++)
            for (int channel = 0; channel < channels; channel++)
                choose(row, col, channel, (1 << planes) - 1);
    return ChosenBits(masks);
}

static LevelShape levelShape(const Parameters& p, int finest, int level, int group)
{
    LevelShape shape = {1 << level, 1 << (finest - level), bitOffset(p, level, group), {}};
    for (int phase = 0; phase < QuadPhase::COUNT; phase++)
        shape.chosen.push_back(chosenBits(p, level, group, phase));
    return shape;
}

//! The groups of channels of a descriptor of quads.
static std::vector<ChannelGroup> groupsOf(const Parameters& p, int finest)
{
    std::vector<ChannelGroup> groups;
    const int channels = p.channelCount();
    for (int first = 0; first < channels; first += GROUP_CHANNELS)
    {
        ChannelGroup group = {first, std::min(channels - first, GROUP_CHANNELS), std::vector<LevelShape>(1)};
        for (int level = 1; level <= finest; level++)
            group.levels.push_back(levelShape(p, finest, level, first / GROUP_CHANNELS));
        groups.push_back(group);
    }
    return groups;
}

Ptr<const DescriptorPlan> makePlan(const Parameters& p)
{
    const std::vector<int> bytes = levelBytes(p);
    const Mat_<int>& s = p.selection;  // levels do not descend
    DescriptorPlan plan = {p, s.empty() ? p.granularity : s(s.rows - 1, 0), bytes,
            std::accumulate(bytes.begin(), bytes.end(), 0), {},
            p.mapping == IIB::MAPPING_BOXES ? makeBoxPlan(p) : BoxPlan(), descriptorKernels()};
    if (!plan.isOfBoxes())
        plan.groups = groupsOf(p, plan.finest);
    return makePtr<const DescriptorPlan>(plan);
}

}  // namespace iib
}  // namespace cv
