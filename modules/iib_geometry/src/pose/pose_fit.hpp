// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "epipolar_problem.hpp"
#include "verdict.hpp"

namespace cv::iib {

const double REFINED = .25;  // least scale by which matches count as agreeing, pixels
const int FEW = 30;          // matches: all of them count

//! A pose that matches agree with.
struct PoseFit : Fit<EpipolarProblem>
{
    std::vector<RelativePose> others;  //!< that may explain the same matches, polished
    double logFalseAlarms = std::numeric_limits<double>::infinity();
    double limit = 0;        //!< the distance, pixels, within which the matches agree by the least chance
    bool wantsMore = false;  //!< whether more samples might find a better one
    double chance = 1;       //!< that a wrong match is so near
};

/** The pose that explains the matches best. The same in every run.

Which of the candidates that is, no single threshold tells: each has the sum of its squared errors, cut off at seven thresholds from one
to twelve scales, of points in front of both cameras. Without a scale, that of refined matches is tried, and wider ones until matches
agree by more than chance.
@param scale of Cauchy's loss, pixels; 0: the errors tell it.
@param weights of the matches in the choice among candidates, or none. */
PoseFit fitPose(const EpipolarProblem& problem, const Verdict& verdict, double scale,
        const std::vector<double>& weights);

//! The scale that the errors tell, if it is wider than that one.
double widerScale(const EpipolarProblem& problem, const std::vector<double>& squared, double scale);

}  // namespace cv::iib
