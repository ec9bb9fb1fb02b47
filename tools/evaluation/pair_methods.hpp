// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "pose_estimates.hpp"

namespace iib_tools {

//! Two images matched from their pixels on, as one would match a single pair.
struct PairMethod
{
    std::string name;
    bool slow;  //!< takes many seconds a pair
    //! Matched points of two CV_8UC1 images; whether the method calls them significant, which matchViews alone decides.
    std::function<bool(const cv::Mat&, const cv::Mat&, Points&)> match;
};

/** matchViews; the recommended chain, upright and propagated; SIFT and ORB, mutual under a ratio, with so many points an image; and
SIFT with so many points in each view of cv::AffineFeature. */
std::vector<PairMethod> pairMethods(int points);

}  // namespace iib_tools
