// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "colmap_model.hpp"
#include "line_features.hpp"
#include "line_map.hpp"

namespace iib_localization {

/** The line in the world that a keyframe sees as a segment: the straight one that the depths along it agree on best,
if three quarters of them do. At an edge of the depth the nearer side counts, since it hides the other.
@param straight the segment without distortion. */
std::optional<MapLine> lineFromDepth(
        const Segment& straight, const Camera& camera, const Pose& pose, const cv::Mat& millimetres);

//! Adds the lines of a keyframe, the next one, whose depths are known.
void addLinesFromDepth(LineMap& map, const LineFeatures& features, const Camera& camera, const Pose& pose,
        const cv::Mat& millimetres);

}  // namespace iib_localization
