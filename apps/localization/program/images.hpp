// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "opencv2/core.hpp"

namespace iib_localization {

//! A name without its extension, as trajectories have it.
std::string withoutExtension(const std::string& name);

/** An image as its file stores it, in grey: EXIF's orientation is ignored, as COLMAP does. Empty if it cannot be read, whatever the
reason. */
cv::Mat readImage(const std::string& path);

/** The names of the images below a folder, in order, but for those below folders of results.
@param results such a folder, or empty.
@throws cv::Exception if there are none, or for names that a trajectory cannot tell apart or cannot hold. */
std::vector<std::string> listImages(const std::string& folder, const std::string& results = "");

}  // namespace iib_localization
