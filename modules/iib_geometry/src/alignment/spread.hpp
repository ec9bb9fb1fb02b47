// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "../verdict/verdict.hpp"
#include "working_pair.hpp"

namespace cv::iib {

/** Whether matches that agree with a transform are all over what shows in both images, or in a logo or a caption alone.

What shows are the points that were looked for, of the image in which they are over less: an image may be masked, or black
elsewhere. */
struct Spread
{
    double area;  //!< that the matches span, over that of what shows
    /** The same over the whole area that both images have and masks allow, but without the few matches that stretch it most: a
    transform bends towards as many wrong ones as determine it, such as some beside a logo. */
    double whole;
    double scatter = 0;  //!< cells that they are in, over those in which as many of the points would be

    /** @param transform from the image to the reference, working pixels.
    @param sampleSize matches that determine one. */
    Spread(const AlignedPoints& points, const Verdict::Marks& agree, const Matx33d& transform,
            const WorkingPair& pair, int sampleSize);
};

}  // namespace cv::iib
