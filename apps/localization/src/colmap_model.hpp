// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "camera.hpp"

namespace iib_localization {

struct Keyframe
{
    std::string name;  //!< the image's file name
    int camera = 0;
    Pose pose;
    std::vector<Eigen::Vector2d>
            pixels;           //!< as seen, with distortion; whole coordinates at centres of pixels
    std::vector<int> points;  //!< for each pixel, the point of the model that is seen there
};

struct Model
{
    Cameras cameras;
    std::vector<Keyframe> keyframes;
    std::vector<Eigen::Vector3d> points;
};

/** Reads a folder with COLMAP's text model; pixels without a point are left out.
@throws cv::Exception for missing or damaged files. */
Model readModel(const std::string& folder);
//! Writes cameras.txt, images.txt and points3D.txt into an existing folder.
void writeModel(const std::string& folder, const Model& model);

}  // namespace iib_localization
