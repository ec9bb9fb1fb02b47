// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "../map/features.hpp"
#include "../pose/camera_pose.hpp"
#include "../views/image_views.hpp"

namespace cv::iib {

/** Matches an image with one of a map's images in views of both, and transfers the keypoints of the map's image like
their nearest match. Finds points at another zoom, rotation or tilt.
@param view number of the map's image, which must have a picture.
@return matches; `keypoint` is the number of the nearest match, `bits` the distance from it in pixels. */
std::vector<Match> matchesInViews(const Map& map, size_t view, const ImageViews& image);

}  // namespace cv::iib
