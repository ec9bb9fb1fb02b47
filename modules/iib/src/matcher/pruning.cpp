// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "../precomp.hpp"
#include "packed_codes.hpp"

namespace cv {
namespace iib {

static void addStop(PruningPolicy& plan, int part, int most = PruneStage::NO_MAX)
{
    const PruneStage stop = {part, most};
    plan.stops.push_back(stop);
}

//! Random differences of n bits spread by sqrt(n) / 2 around n / 2.
static double spread(int bits) { return std::sqrt((double)bits) / 2; }

PruningPolicy exactPlan() { return PruningPolicy(); }

// One stop, where most pairs are beyond the radius; none where they hardly ever are.
PruningPolicy radiusPlan(const CodeLayout& layout, int radius)
{
    PruningPolicy plan;
    plan.limit = radius;
    for (int part = 0, bits = 0; part + 1 < layout.parts() && plan.stops.empty(); part++)
    {
        bits += layout.bits(part);
        if (radius < bits / 2 - 4 * spread(bits))
            addStop(plan, part);
    }
    return plan;
}

PruningPolicy thresholdPlan(const CodeLayout& layout, const std::vector<float>& thresholds)
{
    PruningPolicy plan;
    for (int level = 0; level + 1 < layout.levels(); level++)
        addStop(plan, level, cvFloor((double)thresholds[level] * 8 * layout.levelSizes()[level]));
    return plan;
}

PruningPolicy adaptivePlan(const CodeLayout& layout)
{
    PruningPolicy plan;
    int bits = 0;
    for (int part = 0; part + 1 < layout.parts(); part++)
        bits += layout.bits(part);
    if (bits == 0)
        return plan;
    addStop(plan, layout.parts() - 2);
    plan.margin = cvRound(1.75 * spread(bits));
    return plan;
}

}  // namespace iib
}  // namespace cv
