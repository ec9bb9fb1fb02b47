// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <unordered_map>

#include "lens.hpp"

namespace iib_localization {

struct ModelImage
{
    std::string name;  //!< of the file, below the folder of images
    cv::Affine3d cameraFromWorld;
    std::vector<int64_t> points;  //!< that are seen at its keypoints; -1: none
};

//! A model of COLMAP; all by their ids.
struct Model
{
    std::map<int, Camera> cameras;
    std::map<int, ModelImage> images;
    std::unordered_map<int64_t, cv::Point3d> points;
};

/** Reads cameras.bin, images.bin and points3D.bin. Rigs are not needed, since the images have poses too.
@throws cv::Exception that says which file is missing or damaged, or names a camera model that is not known. */
Model readModel(const std::string& folder);

}  // namespace iib_localization
