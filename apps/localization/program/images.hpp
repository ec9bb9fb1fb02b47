// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace iib_localization {

//! A name without its extension, as trajectories have it.
std::string withoutExtension(const std::string& name);

/** The names of the images below a folder, in order.
@throws cv::Exception if there are none, or for names that a trajectory cannot tell apart or cannot hold. */
std::vector<std::string> listImages(const std::string& folder);

}  // namespace iib_localization
