// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "epipolar_problem.hpp"
#include "../verdict/verdict.hpp"

namespace cv::iib {

//! A pose that matches agree with.
struct PoseFit : Fit<EpipolarProblem>
{
    std::vector<RelativePose> others;  //!< that may explain the same matches, polished
    size_t planar = 0;                 //!< so many of them, the first ones, are the same plane seen otherwise
    double logFalseAlarms = std::numeric_limits<double>::infinity();
    double limit = 0;       //!< the distance, pixels, within which the matches agree by the least chance
    double chance = 1;      //!< that a wrong match is so near
    double errorScale = 0;  //!< pixels: the scale, or a wider one where the errors have long tails
    Verdict::Marks used;    //!< matches that the pose was fitted to in the end, and that its errors come from
};

/** The pose that explains the matches best. The same in every run.

No single threshold shows which of the candidates that is: each has the sum of its squared errors, cut off at seven thresholds, the last
one twelve times the first. A match behind a camera counts as a point at infinity. Half of the samples are of matches that move like their
neighbours. Without a scale, that of refined matches is tried, and wider ones until matches agree by more than chance.
@param scale of Cauchy's loss, pixels; 0: estimated from the errors.
@param weights of the matches in the choice among candidates, or none. */
PoseFit fitPose(const EpipolarProblem& problem, const Verdict& verdict, double scale,
        const std::vector<double>& weights);

}  // namespace cv::iib
