// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "geometry.hpp"

namespace iib_localization {

//! The pose that most matches agree on, not refined (USAC with MAGSAC's score). False if there is none.
bool poseByRansac(const std::vector<Observation>& matches, const Pinhole& camera, Pose& pose);

//! The matches within three pixels of where the pose has them.
std::vector<Observation> agreeing(
        const std::vector<Observation>& matches, const Pinhole& camera, const Pose& pose);

}  // namespace iib_localization
