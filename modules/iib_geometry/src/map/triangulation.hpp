// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "rays.hpp"

namespace cv::iib {

typedef std::vector<Ray> Track;

/** Joins rays into tracks, following the links with the fewest differing bits first. A track has at least two rays, at
most one of an image, and sees at most one point. */
std::vector<Track> tracksOf(const std::vector<Ray>& rays, std::vector<RayMatch> links);

/** Triangulates the point of a track, removing the farthest ray until the others agree.
@return false if fewer than two rays agree, or they are nearly parallel. */
bool triangulatePoint(Track& track, Point3d& point);

/** Triangulates the points of a map, as triangulatePoint does. Keypoints without a point are first refined against one
keypoint of their track. */
void triangulate(Map& map, std::vector<Ray> rays, std::vector<RayMatch> links);

}  // namespace cv::iib
