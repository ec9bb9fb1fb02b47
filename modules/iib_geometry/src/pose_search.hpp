// SPDX-License-Identifier: Apache-2.0
#ifndef IIB_GEOMETRY_POSE_SEARCH_HPP
#define IIB_GEOMETRY_POSE_SEARCH_HPP

#include "epipolar_loss.hpp"

namespace cv {
namespace iib {

/** The pose of the least loss that samples of five matches lead to. The same in every run.
@returns false if no pose has five inliers */
bool searchPose(const EpipolarLoss& loss, RelativePose& pose, std::vector<uchar>& inliers);

}  // namespace iib
}  // namespace cv

#endif
