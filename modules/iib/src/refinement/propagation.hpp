// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#pragma once

#include "match_refiner.hpp"

namespace cv { namespace iib {

//! Adds the matches of further keypoints that the refined ones lead to.
void propagate(const MatchRefiner& refiner, const std::vector<KeyPoint>& keypoints1,
        const std::vector<KeyPoint>& keypoints2, std::vector<Refinement>& matches);

}}  // namespace cv::iib
