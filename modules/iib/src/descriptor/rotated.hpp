// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#ifndef OPENCV_IIB_DESCRIPTOR_ROTATED_HPP
#define OPENCV_IIB_DESCRIPTOR_ROTATED_HPP

#include "keypoint_batches.hpp"
#include "channels.hpp"
#include "support_region.hpp"

namespace cv {
namespace iib {

/* A support region turned by the keypoint's angle cannot use integral images, since |gx| does not turn with it. It is
 sampled on a grid of points instead, and the gradient is turned at each. */

//! The pixels of the image that a turned support region may sample, at least one.
Rect turnedPixels(const SupportRegion& region, const KeyPoint& keypoint, Size image);

/** The bits of the keypoints of a block, all of whose angles are >= 0.
 @param channels all channels of the descriptor.
 @param region, keypoints of the whole image; as are the rows of descriptors. */
void describeTurned(const Parameters& parameters, const std::vector<Channel>& channels, const Block& block,
        const std::vector<SupportRegion>& regions, const std::vector<KeyPoint>& keypoints, Mat& descriptors);

}  // namespace iib
}  // namespace cv

#endif
