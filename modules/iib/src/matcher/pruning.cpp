// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "search.hpp"

namespace cv {
namespace iib {

static void addStage(PruningPolicy& policy, int segment, int most = PruneStage::NO_MAX)
{
    const PruneStage stage = {segment, most};
    policy.stages.push_back(stage);
}

//! Random differences of n bits spread by sqrt(n) / 2 around n / 2.
static double spread(int bits) { return std::sqrt((double)bits) / 2; }

// One stage, where most pairs are beyond the radius; none where they hardly ever are.
PruningPolicy radiusPolicy(const CodeLayout& layout, int radius)
{
    PruningPolicy policy;
    policy.limit = radius;
    for (int segment = 0, bits = 0; segment + 1 < layout.segments() && policy.stages.empty(); segment++)
    {
        bits += layout.bits(segment);
        if (radius < bits / 2 - 4 * spread(bits))
            addStage(policy, segment);
    }
    return policy;
}

// The number meant by a float such as .35f is within FLT_EPSILON of it, so that what ties by that number passes.
PruningPolicy thresholdPolicy(const CodeLayout& layout, const std::vector<float>& thresholds)
{
    PruningPolicy policy;
    for (int level = 0; level + 1 < layout.levels(); level++)
        addStage(policy, level,
                cvFloor(thresholds[level] * (1. + FLT_EPSILON) * 8 * layout.levelSizes()[level]));
    return policy;
}

PruningPolicy adaptivePolicy(const CodeLayout& layout)
{
    PruningPolicy policy;
    int bits = 0;
    for (int segment = 0; segment + 1 < layout.segments(); segment++)
        bits += layout.bits(segment);
    if (bits == 0)
        return policy;
    addStage(policy, layout.segments() - 2);
    policy.margin = cvRound(1.75 * spread(bits));
    return policy;
}

}  // namespace iib
}  // namespace cv
