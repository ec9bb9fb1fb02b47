// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "verdict.hpp"

namespace cv::iib {

/** Matches that a camera which moved has beside a transform of the plane: what is before or behind the plane lies on the line through
where the transform has it and the epipole, one for all (plane and parallax; Hartley and Zisserman 2004, section 13.3).
@param reference, image the matches, N x 2, CV_64F, pixels.
@param transform from the image to the reference.
@param explained matches that the transform explains.
@param limit of distances from a line, pixels.
@return the others that agree with one epipole; none, where chance would give as many. */
Verdict::Marks movedByParallax(const Mat& reference, const Mat& image, const Matx33d& transform,
        const Verdict::Marks& explained, double limit, const Verdict& verdict);

}  // namespace cv::iib
