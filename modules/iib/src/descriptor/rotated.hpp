// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#ifndef OPENCV_IIB_DESCRIPTOR_ROTATED_HPP
#define OPENCV_IIB_DESCRIPTOR_ROTATED_HPP

#include "channels.hpp"
#include "keypoint_batches.hpp"
#include "support_region.hpp"
#include "workspace.hpp"

namespace cv {
namespace iib {

/* A region rotated by the keypoint's angle cannot use integral images, since |gx| does not rotate with it. It is sampled
 on a grid of points instead, and the gradient is rotated at each. */

/** The bits of the keypoints of a batch, all of whose angles are >= 0 or, by ORIENTATION_GRADIENT, found here.
 @param channels all channels of the descriptor.
 @param regions, keypoints of the whole image; as are the rows of descriptors.
 @param ranks which peak of the gradients' directions each keypoint gets; only ORIENTATION_GRADIENT needs them. */
void describeRotated(const DescriptorPlan& plan, const std::vector<Channel>& channels,
        const KeyPointBatch& batch, const std::vector<SupportRegion>& regions,
        const std::vector<KeyPoint>& keypoints, const std::vector<int>& ranks, Workspace& workspace,
        Mat& descriptors);

/** The angles alone of a batch's keypoints, by ORIENTATION_GRADIENT. Parameters as above.
 @param image CV_8U or CV_16U, one channel. @param angles of the whole image's keypoints. */
void prevailingAngles(const DescriptorPlan& plan, const Mat& image, const KeyPointBatch& batch,
        const std::vector<SupportRegion>& regions, const std::vector<KeyPoint>& keypoints,
        const std::vector<int>& ranks, Workspace& workspace, std::vector<float>& angles);

}  // namespace iib
}  // namespace cv

#endif
