// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>

#include "opencv2/iib/localization.hpp"

namespace iib_localization {

//! An image of a COLMAP model.
struct ModelImage
{
    std::string name;  //!< its file, below the folder of the photographs
    cv::iib::Camera camera;
    cv::Affine3d cameraFromWorld;
    std::map<size_t, int> shared;  //!< how many of the model's points it sees together with other images
};

/** The images with a pose of a COLMAP model in binary form, of all versions of COLMAP.
@throws cv::Exception for what is none, is damaged, or has a camera that Lens does not know. */
std::vector<ModelImage> readModel(const std::string& folder);

}  // namespace iib_localization
