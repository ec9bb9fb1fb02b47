// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

#include "../pose/lens.hpp"

namespace cv::iib {

/** Reads the images of a COLMAP model, binary or text, of any version of COLMAP. Keypoints of one point share its
number; the points' positions are not read.
@throws cv::Exception if the model is missing or damaged, or has a camera that Lens does not know. */
std::vector<PosedImage> readModel(const std::string& folder);

//! @throws cv::Exception for a name that no image in a COLMAP model can have.
void checkName(const std::string& name);

//! The index of a camera in a list, or the list's size if the camera is not in it.
inline size_t indexOf(const Camera& camera, const std::vector<Camera>& cameras)
{
    return size_t(std::find_if(cameras.begin(), cameras.end(), [&](const Camera& other) {
        return camera.model == other.model && camera.size == other.size &&
               camera.parameters == other.parameters;
    }) - cameras.begin());
}

//! The distinct cameras of images.
template <typename Images> std::vector<Camera> camerasOf(const Images& images)
{
    std::vector<Camera> cameras;
    for (const PosedImage& image : images)
        if (indexOf(image.camera, cameras) == cameras.size())
            cameras.push_back(image.camera);
    return cameras;
}

}  // namespace cv::iib
