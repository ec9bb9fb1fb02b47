// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "plan.hpp"

#include <numeric>

#include "layout.hpp"
#include "selection.hpp"

namespace cv {
namespace iib {

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

DescriptorPlan::DescriptorPlan(const Parameters& p)
    : parameters(p), finest(finestLevel(p)), levelBytes(iib::levelBytes(p)),
      bytes(std::accumulate(levelBytes.begin(), levelBytes.end(), 0)), kernels(descriptorKernels())
{
    if (p.mapping == IIB::MAPPING_BOXES)
    {
        boxes.reset(new BoxPlan(p));
        return;
    }
    const int channels = p.channelCount();
    for (int first = 0; first < channels; first += GROUP_CHANNELS)
    {
        ChannelGroup group = {first, std::min(channels - first, GROUP_CHANNELS), std::vector<LevelShape>(1)};
        for (int level = 1; level <= finest; level++)
            group.levels.push_back(levelShape(p, finest, level, first / GROUP_CHANNELS, group.count));
        groups.push_back(group);
    }
}

}  // namespace iib
}  // namespace cv
