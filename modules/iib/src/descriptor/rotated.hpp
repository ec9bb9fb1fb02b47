// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#ifndef OPENCV_IIB_DESCRIPTOR_ROTATED_HPP
#define OPENCV_IIB_DESCRIPTOR_ROTATED_HPP

#include "channels.hpp"
#include "keypoint_batches.hpp"
#include "regions.hpp"
#include "workspace.hpp"

namespace cv {
namespace iib {

/* A region rotated by the keypoint's angle cannot use integral images, since |gx| does not rotate with it. It is sampled
 on a grid of points instead, and the gradient is rotated at each. */

/** The bits of the keypoints of a batch, all of whose regions are rotated.
 @param channels all channels of the descriptor.
 @param regions of the whole image, as are the rows of descriptors. */
void describeRotated(const DescriptorPlan& plan, const std::vector<Channel>& channels,
        const KeyPointBatch& batch, const std::vector<SupportRegion>& regions, Workspace& workspace,
        Mat& descriptors);

}  // namespace iib
}  // namespace cv

#endif
