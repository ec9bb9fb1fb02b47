// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "../pose/camera_pose.hpp"
#include "rays.hpp"
#include "segments.hpp"

namespace cv::iib {

/** Adds triangulated lines to a map.
@param segments of each image. @param pairs of images to match. */
void addLines(Map& map, const std::vector<Segments>& segments, const Pairs& pairs);

/** Matches at both ends of the overlap of a line and a segment; only their error across the segment counts. None unless
the projected line is within `limit` pixels of the segment, parallel to it and overlaps a third of the shorter.
@param line in the axes of the pose. */
std::vector<Match> matchesOf(
        const MapLine& line, const Segment& segment, const Lens& lens, const Affine3d& pose, double limit);

/** Matches segments with lines of some of a map's images, near their projections.
@param frame of the pose. */
std::vector<Match> lineMatches(const Map& map, const std::vector<size_t>& images, const Segments& segments,
        const Lens& lens, const Frame& frame, const Affine3d& pose, double limit);

}  // namespace cv::iib
