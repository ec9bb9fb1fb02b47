// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#pragma once

#include "channels.hpp"
#include "keypoint_batches.hpp"
#include "workspace.hpp"

namespace cv {
namespace iib {

/** The bits of the keypoints of a batch, all of whose regions are rotated. Integral images cannot serve, since |gx| does not rotate with the
 region: it is sampled on a grid of points, and the gradient is rotated at each.

@param channels all channels of the descriptor.
@param regions of all keypoints of the image, as are the rows of descriptors. */
void describeRotated(const DescriptorPlan& plan, const std::vector<Channel>& channels,
        const KeyPointBatch& batch, const std::vector<SupportRegion>& regions, Workspace& workspace,
        Mat& descriptors);

}  // namespace iib
}  // namespace cv
