// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "verdict.hpp"

namespace cv::iib {

// Verdicts about a pose between two cameras, by the errors and the parallax of the matches, pixels.

/** Whether more places agree with a pose than with another one, by one and by more than chance. Errors are cut off at four scales, which
is a match more; the noise of matches that agree with both, as all of a plane do, is the chance.
@param squared, otherSquared errors of the matches, pixels^2. */
bool explainsMore(const std::vector<double>& squared, const std::vector<double>& otherSquared, double scale,
        const Verdict& verdict);

/** Whether the direction of t is more than chance. Matches without parallax say nothing of it; of the others one whose parallax is
much longer than the limit agrees with a wrong direction by the chance asin(limit / parallax) 2 / pi.
@param parallaxes of EpipolarProblem::leastParallaxes(). */
bool isDirectionCertain(const std::vector<double>& squared, const std::vector<double>& parallaxes,
        double limit, const Verdict& verdict);

/** Matches within a limit, without those that are probably wrong: whose parallax is longer or shorter than that of most, and of whose
like so many are not within the limit that the few that are may be there by chance. */
Verdict::Marks withinByMoreThanChance(
        const std::vector<double>& squared, const std::vector<double>& parallaxes, double limit);

}  // namespace cv::iib
