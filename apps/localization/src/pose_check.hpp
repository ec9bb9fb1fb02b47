// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#ifndef IIB_LOCALIZATION_POSE_CHECK_HPP
#define IIB_LOCALIZATION_POSE_CHECK_HPP

#include "colmap_model.hpp"
#include "features.hpp"

namespace iib_localization {

/** Whether poses and images are of one scene: of the matches between neighbouring keyframes that agree with an epipolar
geometry, the share that also agrees with the one of the poses. 1 if there are no such matches.
@param features of each of the model's keyframes. */
double poseAgreement(const FeatureMethod& method, const std::vector<Features>& features, const Model& model);

}  // namespace iib_localization

#endif
