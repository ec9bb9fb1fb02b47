// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "epipolar_problem.hpp"
#include "../verdict/verdict.hpp"

namespace cv::iib {

//! A pose that matches agree with.
struct PoseFit : Fit<EpipolarProblem>
{
    std::vector<RelativePose> others;  //!< poses that may explain the same matches, polished
    size_t planar = 0;                 //!< number of these, at the beginning, that see the plane alike
    double logFalseAlarms = std::numeric_limits<double>::infinity();
    double limit = 0;       //!< pixels: the inlier threshold with the fewest expected false alarms
    double chance = 1;      //!< probability that a wrong match is within the limit
    double errorScale = 0;  //!< pixels: the scale, or a wider one if the errors have long tails
    Verdict::Marks used;    //!< matches of the final fit; its uncertainty is estimated from them
};

/** The pose that explains the matches best. Half of the samples are from matches that move like their neighbours. Without a scale, the scale
of refined matches is tried first, then wider ones, until the matches that agree are significant.
@param scale of Cauchy's loss, pixels; 0: estimated from the errors.
@param weights of the matches in the choice among candidates; may be empty. */
PoseFit fitPose(const EpipolarProblem& problem, const Verdict& verdict, double scale,
        const std::vector<double>& weights);

}  // namespace cv::iib
