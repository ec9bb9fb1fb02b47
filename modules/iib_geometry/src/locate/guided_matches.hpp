// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "../map/map.hpp"
#include "../pose/camera_pose.hpp"
#include "../views/image_views.hpp"

namespace cv::iib {

//! An image and those of a map, prepared for refinement.
struct Views
{
    const Map& map;
    PreparedPictures& pictures;  //!< of the map's images
    const PreparedPicture& own;
};

/** Refines the pixels of matches against the map's images, and marks these matches as refined; learnDeviation() gives their deviation.
@param least number of matches with an image of the map; images with fewer are skipped. */
void refineAgainstViews(std::vector<Match>& matches, const Views& views, size_t least);

/** Finds matches near projected map points, refined against the image that sees each point at the most similar size.
@param compared images of the map whose points are used. @param frame of the pose. */
std::vector<Match> guidedMatches(const Views& views, const std::vector<size_t>& compared, const Lens& lens,
        const Frame& frame, const Affine3d& pose);

/** Matches an image with one of a map's images in views of both, and transfers the keypoints of the map's image like
their nearest match. Finds points at another zoom, rotation or tilt.
@param view number of the map's image, which must have a picture.
@return matches; `keypoint` is the number of the nearest match, `bits` the distance from it in pixels (map_in_views.cpp). */
std::vector<Match> matchesInViews(const Map& map, size_t view, const ImageViews& image);

//! Sets the deviation of refined matches to that of their reprojection errors.
void learnDeviation(std::vector<Match>& matches, const Lens& lens, const Affine3d& pose);

}  // namespace cv::iib
