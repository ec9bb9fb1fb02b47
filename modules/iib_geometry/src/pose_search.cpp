// SPDX-License-Identifier: Apache-2.0
#include "pose_search.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "five_points.hpp"
#include "polish.hpp"

namespace cv {
namespace iib {
namespace {

const int SAMPLE = 5;
const int FEWEST_TRIALS = 300, MOST_TRIALS = 10000;
const double CONFIDENCE = .9999;  // that one sample was of right matches alone
const int SHORT_POLISH = 10, LONG_POLISH = 50;
const uint64 SEED = 0x5eed;

void draw(RNG& random, int count, int (&sample)[SAMPLE])
{
    for (int k = 0; k < SAMPLE; k++)
        do
            sample[k] = random.uniform(0, count);
        while (std::find(sample, sample + k, sample[k]) != sample + k);
}

//! Trials until a sample of inliers alone is as good as certain.
double trialsFor(double share)
{
    const double miss = 1 - std::pow(share, SAMPLE);
    return miss <= 0 ? 0 : std::log(1 - CONFIDENCE) / std::log(miss);
}

//! The poses with which the sample is seen in front of both cameras: one of four, unless it is degenerate.
template <class Visit>
void forPosesInFront(const Matx33d& essential, const Point2d* first, const Point2d* second, Visit visit)
{
    RelativePose poses[4];
    posesOf(essential, poses);
    for (RelativePose& pose : poses)
    {
        bool front = true;
        for (int k = 0; k < SAMPLE; k++)
            front = front && inFront(pose, first[k], second[k]);
        if (front)
            visit(pose);
    }
}

}  // namespace

bool searchPose(const EpipolarLoss& loss, RelativePose& pose, std::vector<uchar>& inliers)
{
    const int count = loss.size();
    inliers.assign(count, 0);
    if (count < SAMPLE)
        return false;
    RNG random(SEED);
    std::vector<Matx33d> essentials;
    double bestRaw = std::numeric_limits<double>::max(), best = bestRaw, trials = MOST_TRIALS;
    for (int trial = 0; trial < trials; trial++)
    {
        int sample[SAMPLE];
        draw(random, count, sample);
        Point2d first[SAMPLE], second[SAMPLE];
        for (int k = 0; k < SAMPLE; k++)
        {
            first[k] = loss.first(sample[k]);
            second[k] = loss.second(sample[k]);
        }
        fivePointEssentials(first, second, essentials);
        for (const Matx33d& essential : essentials)
        {
            const double raw = loss.at(essential, bestRaw);
            if (raw >= bestRaw)
                continue;
            forPosesInFront(essential, first, second, [&](RelativePose& candidate) {
                bestRaw = raw;
                polish(loss, candidate, SHORT_POLISH);
                const double polished = loss.at(candidate);
                if (polished >= best)
                    return;
                best = polished;
                pose = candidate;
                const double share = (double)loss.inliers(pose, inliers) / count;
                trials = std::min<double>(MOST_TRIALS, std::max<double>(FEWEST_TRIALS, trialsFor(share)));
            });
        }
    }
    if (best < std::numeric_limits<double>::max())
    {
        polish(loss, pose, LONG_POLISH);
        if (loss.inliers(pose, inliers) >= SAMPLE)
            return true;
    }
    inliers.assign(count, 0);
    return false;
}

}  // namespace iib
}  // namespace cv
