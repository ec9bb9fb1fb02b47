// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#ifndef IIB_TOOLS_NPY_HPP
#define IIB_TOOLS_NPY_HPP

#include <string>

#include "opencv2/core.hpp"

namespace iib_tools {

/** A two-dimensional array of NumPy's `.npy` format, versions 1 to 3: `<f4` or `|u1`, in C order.
@throws cv::Exception with the file's name for anything else. */
cv::Mat readNpy(const std::string& file);

}  // namespace iib_tools

#endif
