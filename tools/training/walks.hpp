// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "opencv2/core.hpp"
#include "opencv2/core/types.hpp"

namespace iib_tools {

//! Two pictures of a rendered walk (tools/synthetic), from two poses and under any two lights.
struct WalkPair
{
    std::string scene;                        //!< "set/scene", without the light
    std::string referenceFile, targetFile;    //!< 640 x 480 or as rendered
    std::string referenceDepth, targetDepth;  //!< 16U, of the same size
    cv::Matx33d camera;                       //!< pixels
    cv::Matx33d rotation;                     //!< from the reference's axes to the target's
    cv::Vec3d translation;                    //!< likewise, in steps of depth
};

//! Ordered pairs of pictures of the walks of common/views.hpp, at most `farthest` apart among frames 1, 2, 5, 6, 9, 10,
//! ...
std::vector<WalkPair> findWalkPairs(const std::vector<std::string>& roots, int farthest);

//! The depth maps and relative pose of two pictures of a walk, which map points from one to the other.
struct Relief
{
    cv::Mat_<ushort> reference, target;  //!< depth along the optical axis; 0: no surface
    cv::Matx33d camera, rotation;
    cv::Vec3d translation;

    //! A keypoint of the reference projected to the target and scaled; size 0 if occluded, outside or of unknown depth.
    cv::KeyPoint project(const cv::KeyPoint& keypoint) const;
    //! Flips both pictures about the vertical axis.
    void mirror();
};

//! @throws cv::Exception for a file that is not a depth map.
Relief loadRelief(const WalkPair& pair);

}  // namespace iib_tools
