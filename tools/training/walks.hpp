// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "opencv2/core.hpp"
#include "opencv2/core/types.hpp"

namespace iib_tools {

//! Two pictures of a rendered walk (tools/synthetic), from two places and under any two lights.
struct WalkPair
{
    std::string scene;                        //!< "set/scene", without the light
    std::string referenceFile, targetFile;    //!< 640 x 480 or as rendered
    std::string referenceDepth, targetDepth;  //!< 16U, of the same size
    cv::Matx33d camera;                       //!< pixels
    cv::Matx33d rotation;                     //!< from the reference's axes to the target's
    cv::Vec3d translation;                    //!< of the same, in steps of depth
};

//! Ordered pairs of pictures of common/views.hpp's walks that lie up to `farthest` frames apart: frames 1, 2, 5, 6, 9, 10, ...
std::vector<WalkPair> findWalkPairs(const std::vector<std::string>& roots, int farthest);

//! What is seen where in the two pictures of a walk.
struct Relief
{
    cv::Mat_<ushort> reference, target;  //!< depth along the optical axis; 0: nothing there
    cv::Matx33d camera, rotation;
    cv::Vec3d translation;

    //! Where the target sees a keypoint of the reference, its size in proportion; size 0 if hidden, outside or unknown.
    cv::KeyPoint project(const cv::KeyPoint& keypoint) const;
    //! That of both pictures flipped about the vertical axis.
    void mirror();
};

//! @throws cv::Exception for a file that is no depth map.
Relief loadRelief(const WalkPair& pair);

}  // namespace iib_tools
