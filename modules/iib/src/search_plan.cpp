// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "precomp.hpp"
#include "index.hpp"

namespace cv {
namespace iib {

static HammingStop stopAt(int steps)
{
    const HammingStop stop = { steps, HammingStop::NO_MAX, -1 };
    return stop;
}

SearchPlan exactPlan()
{
    return SearchPlan();
}

SearchPlan radiusPlan(const HammingLayout& layout, int radius)
{
    SearchPlan plan;
    for (int level = 0; level + 1 < layout.levels(); level++)
        plan.stops.push_back(stopAt(layout.end(level)));
    plan.limits.assign(plan.stops.size(), radius);
    return plan;
}

SearchPlan thresholdPlan(const HammingLayout& layout, const std::vector<float>& thresholds)
{
    SearchPlan plan = radiusPlan(layout, INT_MAX);
    for (size_t level = 0; level < plan.stops.size(); level++)
        plan.stops[level].levelMax = cvFloor((double)thresholds[level] * 8 * layout.levelSizes()[level]);
    return plan;
}

// Random differences of n bits spread by sqrt(n) / 2: margins of 1.6 and 1 such spreads. The levels before the
// last are too few bits to tell on a hard pair, so the first stop takes a quarter of the last one with them.
SearchPlan adaptivePlan(const HammingLayout& layout)
{
    SearchPlan plan;
    if (layout.levels() == 1)
        return plan;
    const int coarse = layout.end(layout.levels() - 2), fine = layout.steps() - coarse;
    const int places[] = { coarse + fine / 4, coarse + fine / 2 };
    const double margins[] = { 0.8, 0.5 };
    for (int i = 0; i < 2; i++)
    {
        plan.stops.push_back(stopAt(places[i]));
        plan.stops.back().margin = cvRound(margins[i] * std::sqrt((double)layout.bits(places[i])));
    }
    plan.limits.assign(plan.stops.size(), INT_MAX);
    return plan;
}

}  // namespace iib
}  // namespace cv
