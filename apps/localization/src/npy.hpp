// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "opencv2/core.hpp"

namespace iib_localization {

/** A two-dimensional array of bytes of NumPy's `.npy` format, version 1, in C order.
@throws cv::Exception with the file's name for anything else. */
cv::Mat readNpy(const std::string& file);

}  // namespace iib_localization
