// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "colmap_model.hpp"
#include "line_features.hpp"
#include "line_map.hpp"

namespace iib_localization {

/** Lines that keyframes with known poses see: segments of two keyframes near each other whose codes are nearest make a
line, where the planes through the cameras and the segments cross; it stays if three keyframes or more see it.
@param features of each keyframe of the model. */
LineMap triangulateLines(const std::vector<LineFeatures>& features, const Model& model);

}  // namespace iib_localization
