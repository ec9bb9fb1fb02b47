// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#ifndef OPENCV_IIB_DESCRIPTOR_UPRIGHT_HPP
#define OPENCV_IIB_DESCRIPTOR_UPRIGHT_HPP

#include "keypoint_batches.hpp"
#include "channels.hpp"
#include "support_region.hpp"

namespace cv {
namespace iib {

/** The bits that one group of channels gives to the keypoints of a block, their support region upright.

@param channels 1 to GROUP_CHANNELS.
@param group which four of the descriptor's channels they are.
@param region of all keypoints of the image.
@param descriptors rows for all keypoints of the image. */
void describeUpright(const Parameters& parameters, const std::vector<Channel>& channels, int group,
        const Block& block, const std::vector<SupportRegion>& regions, Mat& descriptors);

}  // namespace iib
}  // namespace cv

#endif
