// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "colmap_model.hpp"
#include "features.hpp"

namespace iib_localization {

/** Whether poses and images are of one scene: of the matches between neighbouring keyframes that agree with an epipolar
geometry, the share that also agrees with the one of the poses. 1 if there are no such matches.
@param features of each of the model's keyframes. */
double poseAgreement(const FeatureMethod& method, const std::vector<Features>& features, const Model& model);

}  // namespace iib_localization
