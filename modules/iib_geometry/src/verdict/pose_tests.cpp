// SPDX-License-Identifier: Apache-2.0
#include "pose_tests.hpp"

#include <cmath>
#include <numeric>

namespace cv::iib {
namespace {

const int TRIALS = 300;
const int SAMPLE = 2;  // lines that determine an epipole

Vec3d homogeneous(const Point2d& point) { return Vec3d(point.x, point.y, 1); }

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
        for (int k = 0; 1 - fewer > chance && k < near && k < 100; k++)
        {
            fewer += term;
            term *= expected / (k + 1);
        }
        if (1 - fewer > chance)
            marks[i] = false;
    }
    return marks;
}

Verdict::Marks movedByParallax(const Points& reference, const Points& image, const Matx33d& transform,
        const Verdict::Marks& explained, double limit, const Verdict& verdict)
{
    std::vector<int> others;
    std::vector<Vec3d> planar, lines;
    Verdict::Marks all(explained.size()), best(explained.size());
    double chances = 0;
    for (size_t i = 0; i < explained.size(); i++)
    {
        if (explained[i])
            continue;
        Vec3d there = transform * homogeneous(image[i]);
        there *= 1 / there[2];
        const Vec3d here = homogeneous(reference[i]);
        // The chance that a wrong match, whose direction is random, comes as near to the line.
        chances += 2 / CV_PI * std::asin(std::min(1., limit / norm(here - there)));
        all[i] = true;
        others.push_back((int)i);
        planar.push_back(there);
        lines.push_back(there.cross(here));
    }
    if (others.size() <= SAMPLE)
        return best;
    RNG random(0x5eed);
    int most = 0;
    for (int trial = 0; trial < TRIALS; trial++)
    {
        const int a = random.uniform(0, (int)lines.size()), b = random.uniform(0, (int)lines.size());
        const Vec3d epipole = lines[a].cross(lines[b]);
        Verdict::Marks agree(explained.size());
        int count = 0;
        for (size_t k = 0; k < others.size(); k++)
        {
            const Vec3d line = epipole.cross(planar[k]), here = homogeneous(reference[others[k]]);
            const bool near = square(line.dot(here)) < limit * limit * (square(line[0]) + square(line[1]));
            agree[others[k]] = near;
            count += near;
        }
        if (count > most)
        {
            most = count;
            best = agree;
        }
    }
    const double chance = chances / (double)others.size();
    return verdict.logFalseAlarms(all, best, SAMPLE, chance) < Verdict::CERTAIN
                   ? best
                   : Verdict::Marks(explained.size());
}

}  // namespace cv::iib
