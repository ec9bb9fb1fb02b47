// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "opencv2/core.hpp"
#include "opencv2/core/affine.hpp"

namespace iib_tools {

//! Two pictures with depth of a rendered walk (tools/synthetic/views.py --walk), from two poses and under any two lights.
struct WalkPair
{
    std::string scene;                      //!< "set/scene", without the light
    std::string referenceFile, targetFile;  //!< `images/NAME.png`; their depth is in `depth/NAME.png`
    cv::Matx33d camera;                     //!< pixels
    cv::Affine3d motion;                    //!< from the reference's axes to the target's, metres
};

/** Ordered pairs of pictures in folders of one scene, at most `farthest` apart among numbers 0, 1, 4, 5, 8, 9, ...
@throws cv::Exception for a broken camera or pose. */
std::vector<WalkPair> findWalkPairs(const std::vector<std::string>& roots, int farthest);

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
Relief loadRelief(const WalkPair& pair);

}  // namespace iib_tools
