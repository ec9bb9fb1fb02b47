// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#pragma once

#include "../keypoint_batches.hpp"
#include "../regions.hpp"
#include "../workspace.hpp"

namespace cv {
namespace iib {

//! The pixels that the boxes of a region cover, rotated by any angle or upright, in whole cells; some may be reflected.
Rect boxPixels(const SupportRegion& region, int border, Size image);

/** The descriptors of a batch by MAPPING_BOXES, whose regions are all upright or all rotated.

Upright boxes lie on a grid, whose edges many of them share. A rotated keypoint needs no samples: the means of gx and gy
are linear in them and so rotate as they do, and those of |gx| and |gy| come from the means of |gx|, |gy|, |gx + gy| and
|gx - gy|, that is, of the gradient's magnitude in four directions. Boxes stay upright; only their centres turn.

@param grey the image, CV_8U or CV_16U.
@param regions of all keypoints, as are their boxPixels() and the rows of descriptors. */
void describeBoxes(const DescriptorPlan& plan, const Mat& grey, const KeyPointBatch& batch,
        const std::vector<SupportRegion>& regions, const std::vector<Rect>& pixels, Workspace& workspace,
        Mat& descriptors);

}  // namespace iib
}  // namespace cv
