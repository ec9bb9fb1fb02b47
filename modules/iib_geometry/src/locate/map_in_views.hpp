// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "../map/features.hpp"
#include "../pose/camera_pose.hpp"
#include "../views/image_views.hpp"

namespace cv::iib {

/** Where points of a map are seen in an image that was taken from nearer, farther, aside or rotated: the image is matched with one of the map's
images in views of both, and the keypoints of that image move as the nearest match does.
@param view number of the map's image, whose picture must be there.
@return with the numbers of the matches that they move with as keypoints, and the distances from those in pixels as bits; none if the images do not match in any view. */
std::vector<Match> matchesInViews(const Map& map, size_t view, const ImageViews& image);

}  // namespace cv::iib
