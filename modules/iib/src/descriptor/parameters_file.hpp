// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#ifndef OPENCV_IIB_DESCRIPTOR_PARAMETERS_FILE_HPP
#define OPENCV_IIB_DESCRIPTOR_PARAMETERS_FILE_HPP

#include "parameters.hpp"

namespace cv {
namespace iib {

//! As keys of the map that is open in `fs`.
void writeParameters(FileStorage& fs, const Parameters& parameters);

/** What writeParameters wrote; `present` is kept where a number is missing.
 @throws cv::Exception for another format and for what is no parameter or out of its range. */
Parameters readParameters(const FileNode& node, const Parameters& present);

}  // namespace iib
}  // namespace cv

#endif
