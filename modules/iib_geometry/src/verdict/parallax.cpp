// SPDX-License-Identifier: Apache-2.0
#include "parallax.hpp"

#include <cmath>

namespace cv::iib {
namespace {

const int TRIALS = 300;
const int SAMPLE = 2;  // lines that determine an epipole

Vec3d homogeneous(const Mat& points, int i)
{
    return Vec3d(points.at<double>(i, 0), points.at<double>(i, 1), 1);
}

}  // namespace

Verdict::Marks movedByParallax(const Mat& reference, const Mat& image, const Matx33d& transform,
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
        Vec3d there = transform * homogeneous(image, (int)i);
        there *= 1 / there[2];
        const Vec3d here = homogeneous(reference, (int)i);
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
            const Vec3d line = epipole.cross(planar[k]), here = homogeneous(reference, others[k]);
            const bool near = std::abs(line.dot(here)) < limit * std::hypot(line[0], line[1]);
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
