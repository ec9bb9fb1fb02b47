// SPDX-License-Identifier: Apache-2.0
#include "pose_verdict.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace cv::iib {
namespace {

double square(double x) { return x * x; }

//! The chance that the epipolar line of a wrong match passes it within the limit, in front of the camera or behind it.
double chanceOf(double limit, double parallax)
{
    return std::asin(std::min(1., limit / parallax)) * 2 / CV_PI;
}

}  // namespace

bool explainsMore(const std::vector<double>& squared, const std::vector<double>& otherSquared, double scale,
        const Verdict& verdict)
{
    const double level = 3;  // standard deviations
    const double farthest2 = square(4 * scale), inside2 = square(3 * scale);
    std::vector<double> all(squared.size()), both = all;
    for (size_t i = 0; i < all.size(); i++)
    {
        all[i] = (std::min(otherSquared[i], farthest2) - std::min(squared[i], farthest2)) / farthest2;
        if (std::max(otherSquared[i], squared[i]) < inside2)
            both[i] = all[i];
    }
    double more = 0, chance2 = 0;
    for (double place : verdict.sumsOfPlaces(all))
        more += std::clamp(place, -1., 1.);
    for (double place : verdict.sumsOfPlaces(both))
        chance2 += square(std::clamp(place, -1., 1.));
    return more >= 1 + level * std::sqrt(chance2);
}

bool isDirectionCertain(const std::vector<double>& squared, const std::vector<double>& parallaxes,
        double limit, const Verdict& verdict, double certain)
{
    const int matchesOfDirection = 2;
    Verdict::Marks seen(squared.size()), agree = seen;
    double chances = 0, count = 0;
    for (size_t i = 0; i < squared.size(); i++)
    {
        if (parallaxes[i] < 2 * limit)
            continue;
        seen[i] = true;
        agree[i] = squared[i] < limit * limit;
        chances += chanceOf(limit, parallaxes[i]);
        count++;
    }
    const double chance = chances / std::max(count, 1.),
                 others = verdict.places(seen) - verdict.places(agree);
    // The chance is so large here that the matches which do not agree count, too.
    return verdict.logFalseAlarms(seen, agree, matchesOfDirection, chance) + others * std::log10(1 - chance) <
           certain;
}

Verdict::Marks withinByMoreThanChance(
        const std::vector<double>& squared, const std::vector<double>& parallaxes, double limit)
{
    const double alike = 1.5;   // largest ratio of similar parallaxes
    const double chance = .01;  // of as many wrong matches within the limit
    const Verdict::Marks all = within(limit, squared);
    Verdict::Marks marks = all;
    std::vector<size_t> order(squared.size());
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(
            order.begin(), order.end(), [&](size_t a, size_t b) { return parallaxes[a] < parallaxes[b]; });
    size_t begin = 0, end = 0;
    double near = 0,
           expected = 0;  // matches of similar parallax within the limit, and wrong ones expected there
    const auto add = [&](size_t i, double sign) {
        const double each = chanceOf(limit, parallaxes[i]) / 2;  // in front of the camera
        if (all[i])
            near += sign;
        else
            expected += sign * each / (1 - each);
    };
    for (size_t i : order)
    {
        for (; end < order.size() && parallaxes[order[end]] <= alike * parallaxes[i]; end++)
            add(order[end], 1);
        for (; parallaxes[order[begin]] * alike < parallaxes[i]; begin++)
            add(order[begin], -1);
        double term = std::exp(-expected), fewer = 0;  // Poisson's distribution
        for (int k = 0; k < near && k < 100; k++)
        {
            fewer += term;
            term *= expected / (k + 1);
        }
        if (1 - fewer > chance)
            marks[i] = false;
    }
    return marks;
}

}  // namespace cv::iib
