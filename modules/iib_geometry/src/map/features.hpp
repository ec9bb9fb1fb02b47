// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "map.hpp"
#include "opencv2/iib.hpp"

namespace cv::iib {

//! What is found in an image: it has no name, camera and pose, and sees no points yet.
typedef MapImage Features;

//! What finds and describes the points of a map: createRecommended, or the paper's points and descriptor.
Ptr<IIB> describerOf(bool orbAndAkaze, int points);

/** @param maxSize pixels of the longer side to which a larger image is reduced; 0: it is not. Keypoints are in the image's own pixels.
@param features of the image.
@param angle degrees by which the image is rotated, clockwise, at which its keypoints are described; -1: upright. */
void extract(
        IIB& iib, const Mat& image, const Mat& mask, Features& features, int maxSize = 0, float angle = -1);

//! @throws cv::Exception for an image that is not of a camera's size, or not 8-bit, grey or BGR, and another mask.
inline void checkPhotograph(const Mat& image, const Mat& mask, const Size& size)
{
    if (!mask.empty() && (mask.type() != CV_8UC1 || mask.size() != image.size()))
        CV_Error(Error::StsBadArg, "a mask is CV_8UC1, of its image's size");
    if (image.type() != CV_8UC1 && image.type() != CV_8UC3)
        CV_Error(Error::StsBadArg, "an image is 8-bit, grey or BGR, not " + typeToString(image.type()));
    if (image.size() != size)
        CV_Error(Error::StsBadArg, format("the image has %d x %d pixels and its camera %d x %d", image.cols,
                                           image.rows, size.width, size.height));
}

}  // namespace cv::iib
