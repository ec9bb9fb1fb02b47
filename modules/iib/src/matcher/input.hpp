// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#ifndef OPENCV_IIB_MATCHER_INPUT_HPP
#define OPENCV_IIB_MATCHER_INPUT_HPP

#include "packed_codes.hpp"

namespace cv {
namespace iib {

//! One matrix of descriptors, or several, of one image each.
std::vector<Mat> imagesOf(InputArrayOfArrays descriptors);

//! Bytes of a descriptor of the first image that has any; 0 if none has.
int widthOf(const std::vector<Mat>& images);

//! The descriptors if they are of `width` bytes each, 0 x width if there are none; throws otherwise. `byFirstCodes`
//! tells the error where the width came from: from the codes that came first, or from level sizes.
Mat checkedDescriptors(const Mat& descriptors, int width, bool byFirstCodes);

//! A mask for each image of the index, or none if all are empty; throws where one does not fit.
std::vector<Mat> checkedMasks(InputArrayOfArrays masks, int queries, const PackedCodes& index);

}  // namespace iib
}  // namespace cv

#endif
