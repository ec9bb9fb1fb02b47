// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "common/views.hpp"
#include "opencv2/core/types.hpp"

namespace iib_tools {

/** Finds ordered pairs of pictures with depth images, from two poses of a rendered walk and under any two lights: folders of one
place (tools/synthetic/views.py --walk). Pictures are at most `farthest` apart among numbers 0, 1, 4, 5, 8, 9, ... */
std::vector<ViewPair> findWalkPairs(const std::vector<std::string>& roots, int farthest);

//! The depth maps and relative pose of two pictures of a walk, which map points from one to the other.
struct Relief
{
    cv::Mat_<ushort> reference, target;  //!< depth along the optical axis; 0: no surface
    cv::Matx33d camera, rotation;
    cv::Vec3d translation;  //!< in steps of depth

    //! A keypoint of the reference projected to the target and scaled; size 0 if occluded, outside or of unknown depth.
    cv::KeyPoint project(const cv::KeyPoint& keypoint) const;
    //! Flips both pictures about the vertical axis.
    void mirror();
};

//! @throws cv::Exception for a file that is not a depth map.
Relief loadRelief(const ViewPair& pair);

}  // namespace iib_tools
