// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#ifndef OPENCV_IIB_DESCRIPTOR_BOXES_HPP
#define OPENCV_IIB_DESCRIPTOR_BOXES_HPP

#include "channels.hpp"
#include "keypoint_batches.hpp"
#include "support_region.hpp"
#include "workspace.hpp"

namespace cv {
namespace iib {

/** The pixels that the boxes of a keypoint cover, of whole cells; some may be reflected.
 @param rotated by any angle. */
Rect boxPixels(const SupportRegion& region, Point2f centre, bool rotated, int border, Size image);

/** The descriptors of a batch by MAPPING_BOXES.

Upright boxes lie on a grid, whose edges many of them share. A rotated keypoint needs no samples: the means of gx and gy
are linear in them and so rotate as they do, and those of |gx| and |gy| come from the means of |gx|, |gy|, |gx + gy| and
|gx - gy|, that is, of the gradient's magnitude in four directions. Boxes stay upright; only their centres turn.

@param image CV_8U or CV_16U, one channel.
@param regions of all keypoints, as are keypoints, angles (null: all of the batch are upright) and the rows of descriptors. */
void describeBoxes(const DescriptorPlan& plan, const Mat& image, const KeyPointBatch& batch,
        const std::vector<SupportRegion>& regions, const std::vector<KeyPoint>& keypoints,
        const std::vector<float>* angles, Workspace& workspace, Mat& descriptors);

}  // namespace iib
}  // namespace cv

#endif
