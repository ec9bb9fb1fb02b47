// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#ifndef OPENCV_IIB_DESCRIPTOR_INPUT_HPP
#define OPENCV_IIB_DESCRIPTOR_INPUT_HPP

#include "../common/image_input.hpp"

namespace cv {
namespace iib {

/** Makes one map of the rows of a single map. Python's bindings take an array of two dimensions where several maps are
 expected for a list, and hand over each of its rows, until OpenCV 5 as a column. */
void joinRows(std::vector<Mat>& maps, Size imageSize);

//! Throws unless there are `expected` single-channel maps of the image's size, 8U, 16U or 32F and finite.
void checkExtraChannels(const std::vector<Mat>& maps, int expected, Size imageSize);

//! Throws unless position and size of every keypoint are finite and the size is positive.
void checkKeyPoints(const std::vector<KeyPoint>& keypoints);

}  // namespace iib
}  // namespace cv

#endif
