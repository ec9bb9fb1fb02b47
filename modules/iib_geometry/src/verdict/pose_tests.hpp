// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "verdict.hpp"

namespace cv::iib {

// Tests of a pose between two cameras by the errors and the parallax of the matches, pixels.

/** Whether more places agree with a pose than with another one, by one place and significantly. Errors are cut off at four scales, which counts as one
match. The noise of matches that agree with both poses, as all matches of a plane do, is the chance.
@param squared, otherSquared errors of the matches, pixels^2. */
bool explainsMore(const std::vector<double>& squared, const std::vector<double>& otherSquared, double scale,
        const Verdict& verdict);

/** Whether the direction of t is significant. Matches without parallax do not determine it. A match whose parallax is much longer than the limit
agrees with a wrong direction by the chance asin(limit / parallax) 2 / pi.
@param certain logarithm of the false alarms that are allowed; -1 if a rotation has minimized the parallaxes, which leaves little to chance. */
bool isDirectionCertain(const std::vector<double>& squared, const std::vector<double>& parallaxes,
        double limit, const Verdict& verdict, double certain = Verdict::CERTAIN);

/** Matches within a limit, without those that are probably wrong. Their parallax differs from that of most matches, and so many matches of
similar parallax are beyond the limit that a few are within it by chance. */
Verdict::Marks withinByMoreThanChance(
        const std::vector<double>& squared, const std::vector<double>& parallaxes, double limit);

/** Matches off the plane's transform that a camera translation explains: such a match lies on the line through its place by the transform and the
epipole, which all share (plane and parallax; Hartley and Zisserman 2004, section 13.3).
@param reference, image the matches, pixels.
@param transform from the image to the reference.
@param explained matches that agree with the transform.
@param limit largest distance from a line, pixels.
@return the other matches that agree with one epipole; none if their number is not significant. */
Verdict::Marks movedByParallax(const Points& reference, const Points& image, const Matx33d& transform,
        const Verdict::Marks& explained, double limit, const Verdict& verdict);

}  // namespace cv::iib
