// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "opencv2/core.hpp"

namespace cv::iib {

/** The essential matrices, up to ten, that fit five matches (Nister 2004).
@param first, second directions in the two cameras, third coordinate 1
@param essentials cleared, then filled */
void fivePointEssentials(const Point2d first[5], const Point2d second[5], std::vector<Matx33d>& essentials);

}  // namespace cv::iib
