// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "opencv2/iib/localization.hpp"

namespace iib_localization {

using cv::iib::PosedImage;

/** The images of a COLMAP model, binary or text, of all versions of COLMAP. What they see are numbers that images of one point
share; where the points are is not read.
@throws cv::Exception for what is none, is damaged, or has a camera that Lens does not know. */
std::vector<PosedImage> readModel(const std::string& folder);

}  // namespace iib_localization
