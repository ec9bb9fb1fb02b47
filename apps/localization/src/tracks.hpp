// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <set>

#include "colmap_model.hpp"
#include "features.hpp"

namespace iib_localization {

//! Pairs of keyframes that may see the same: each with the six nearest that look the same way within 60 degrees.
std::set<std::pair<int, int>> nearPairs(const std::vector<Keyframe>& keyframes);

/** Matches keyframes with those near them, follows points from one to the next, triangulates and adjusts them.
@param refinePoses lets the adjustment move the model's poses.
@param model gets the points.
@return for each feature of each keyframe the model's point, or -1. */
std::vector<std::vector<int>> triangulateTracks(
        const FeatureMethod& method, const std::vector<Features>& features, bool refinePoses, Model& model);

}  // namespace iib_localization
