// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#pragma once

#include "batch_job.hpp"

namespace cv { namespace iib {

//! The pixels that the boxes of a region cover, rotated by any angle or upright, in whole squares; some may be reflected.
Rect boxPixels(const SupportRegion& region, int border, Size image);

/** Describes a batch by MAPPING_BOXES.

Upright boxes lie on a grid, whose edges many of them share. A rotated keypoint needs no samples: the means of gx and gy
are linear in them and so rotate as they do, and those of |gx| and |gy| come from the means of |gx|, |gy|, |gx + gy| and
|gx - gy|, that is, of the gradient's magnitude in four directions. Boxes stay upright; only their centres turn. */
void describeBoxes(const BatchJob& job);

}}  // namespace cv::iib
