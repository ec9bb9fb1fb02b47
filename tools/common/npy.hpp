// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "opencv2/core.hpp"

namespace iib_tools {

/** A two-dimensional array of NumPy's `.npy` format, versions 1 to 3: `<f4` or `|u1`, in C order.
@throws cv::Exception with the file's name for anything else. */
cv::Mat readNpy(const std::string& file);

}  // namespace iib_tools
