// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "verdict.hpp"

namespace cv::iib {

/** Matches off the plane's transform that a camera translation explains: such a match lies on the line through its place by the transform and the
epipole, which all share (plane and parallax; Hartley and Zisserman 2004, section 13.3).
@param reference, image the matches, N x 2, CV_64F, pixels.
@param transform from the image to the reference.
@param explained matches that agree with the transform.
@param limit largest distance from a line, pixels.
@return the other matches that agree with one epipole; none if their number is not significant. */
Verdict::Marks movedByParallax(const Mat& reference, const Mat& image, const Matx33d& transform,
        const Verdict::Marks& explained, double limit, const Verdict& verdict);

}  // namespace cv::iib
