// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "plan.hpp"

#include <numeric>

namespace cv {
namespace iib {

//! The bits that a selection chooses in a phase of a level. @param group which four of the channels.
static ChosenBits chosenBits(const Parameters& p, int level, int group, int index)
{
    const QuadPhase phase(1 << level, index);
    const int planes = bitsPerQuad(p.mapping), planeBits = 8 * phase.planeBytes();
    std::vector<uint64> masks((phase.rows * planes * planeBits + 63) / 64, 0);
    for (int i = 0; i < p.selection.rows; i++)
    {
        const int* quad = p.selection[i];
        const int channel = quad[1], row = quad[2], col = quad[3];
        if (quad[0] != level || channel / GROUP_CHANNELS != group || row % 2 != phase.dy ||
                col % 2 != phase.dx)
            continue;
        for (int plane = 0; plane < planes; plane++)
        {
            const int bit = (row / 2 * planes + plane) * planeBits + col / 2 * GROUP_CHANNELS +
                            channel % GROUP_CHANNELS;
            masks[bit / 64] |= (uint64)(quad[4] >> plane & 1) << bit % 64;
        }
    }
    return ChosenBits(masks);
}

static LevelShape levelShape(const Parameters& p, int finest, int level, int group, int channels)
{
    LevelShape shape = {1 << level, 1 << (finest - level), bitOffset(p, level, group), channels,
            p.overlap ? (1 << QuadPhase::COUNT) - 1 : 1, std::vector<ChosenBits>()};
    if (p.selection.empty())
        return shape;
    shape.phases = 0;
    for (int phase = 0; phase < QuadPhase::COUNT; phase++)
    {
        shape.chosen.push_back(chosenBits(p, level, group, phase));
        shape.phases |= !shape.chosen[phase].none() << phase;
    }
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
            group.levels.push_back(levelShape(p, finest, level, first / GROUP_CHANNELS, group.count));
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
