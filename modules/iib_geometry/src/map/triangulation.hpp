// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "rays.hpp"

namespace cv::iib {

typedef std::vector<Ray> Track;

/** The tracks of two rays or more that links join, the surest first. A track holds one ray of an image and sees one point at
most. */
std::vector<Track> tracksOf(const std::vector<Ray>& rays, std::vector<RayMatch> links);

/** Places the point of a track, without the rays that are farthest from it until the others agree.
@return false if too few rays agree, or look from nearly the same direction. */
bool place(Track& track, Point3d& point);

/** Places what the keypoints of a map's images see. Keypoints that see no point yet are moved to what one of their track shows,
the reference. The rays farthest from a track's point are left out until the others agree; it has none if too few do, or look from nearly
the same direction. */
void triangulate(Map& map, const std::vector<Ray>& rays, const std::vector<RayMatch>& links);

}  // namespace cv::iib
