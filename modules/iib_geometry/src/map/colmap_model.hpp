// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

#include "../pose/lens.hpp"

namespace cv::iib {

/** The images of a COLMAP model, binary or text, of all versions of COLMAP. What they see are numbers that images of one point
share; where the points are is not read.
@throws cv::Exception if there is none, it is damaged, or it has a camera that Lens does not know. */
std::vector<PosedImage> readModel(const std::string& folder);

//! @throws cv::Exception for a name that no image in a COLMAP model can have.
void checkName(const std::string& name);

//! The index of a camera among others; how many there are, if it is not there.
inline size_t indexOf(const Camera& camera, const std::vector<Camera>& cameras)
{
    return size_t(std::find_if(cameras.begin(), cameras.end(), [&](const Camera& other) {
        return camera.model == other.model && camera.size == other.size &&
               camera.parameters == other.parameters;
    }) - cameras.begin());
}

//! The cameras of images, each once.
template <typename Images> std::vector<Camera> camerasOf(const Images& images)
{
    std::vector<Camera> cameras;
    for (const PosedImage& image : images)
        if (indexOf(image.camera, cameras) == cameras.size())
            cameras.push_back(image.camera);
    return cameras;
}

}  // namespace cv::iib
