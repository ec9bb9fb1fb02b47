// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "../pose/camera_pose.hpp"
#include "map.hpp"
#include "segments.hpp"

namespace cv::iib {

/** Triangulates the lines that images of a map see.
@param segments of each image. @param pairs of images to be matched. */
void addLines(
        Map& map, const std::vector<Segments>& segments, const std::vector<std::pair<size_t, size_t>>& pairs);

/** The two places where a line and a segment begin and end to overlap, as matches of which only the error across the segment
counts. None unless the line is seen within `limit` pixels of the segment in its direction, along a third of the shorter.
@param line in the axes of the pose. */
std::vector<Match> matchesOf(
        const MapLine& line, const Segment& segment, const Lens& lens, const Affine3d& pose, double limit);

/** Matches with the lines that some of a map's images see, near where a pose has them.
@param frame of the pose. */
std::vector<Match> lineMatches(const Map& map, const std::vector<size_t>& images, const Segments& segments,
        const Lens& lens, const Frame& frame, const Affine3d& pose, double limit);

}  // namespace cv::iib
