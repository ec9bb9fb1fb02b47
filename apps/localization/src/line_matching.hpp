// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "opencv2/core.hpp"

#include "geometry.hpp"

namespace iib_localization {

//! Segments without distortion, with their codes.
struct DescribedSegments
{
    std::vector<Segment> segments;
    cv::Mat codes;
};

//! A line segment in the world with its code.
struct Line3
{
    Eigen::Vector3d begin, end;
    const uchar* code;
};

/** The piece of a line of the world that a camera sees where a segment of its image is.
@return none if the line would be seen elsewhere: over `maxDistance` pixels away or 5 degrees turned, or only a piece of
less than 10 pixels, or of less than a third of the shorter one, would be seen beside the segment. */
std::optional<LineObservation> seenAs(const Eigen::Vector3d& begin, const Eigen::Vector3d& end,
        const Segment& segment, const Pinhole& camera, const Pose& pose, double maxDistance);

/** Matches lines of one keyframe with the segments of an image whose pose is nearly known: of the segments that lie
where the line would be seen, the one with the nearest code, if no other line is nearer to that one.
@param maxDistance from where the line would be seen, in pixels. */
std::vector<LineObservation> matchLines(const std::vector<Line3>& lines, const DescribedSegments& image,
        const Pinhole& camera, const Pose& pose, double maxDistance);

//! The lines within two pixels of where the pose has them.
std::vector<LineObservation> agreeing(
        const std::vector<LineObservation>& matches, const Pinhole& camera, const Pose& pose);

//! The standard deviation of lines' distances in pixels, from their median, so that a few wrong ones do not count.
double deviation(const std::vector<LineObservation>& lines, const Pinhole& camera, const Pose& pose);

}  // namespace iib_localization
