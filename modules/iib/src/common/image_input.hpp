// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#pragma once

#include "../precomp.hpp"

namespace cv {
namespace iib {

/* Images that users pass, checked, as single-channel integer maps (CV_8U or CV_16U), on which all later decisions
 are exact. */

//! Throws unless the pixels are 8U, 16U or 32F and finite; `what` names the image in the message.
void checkPixels(const Mat& m, const String& what);

//! Throws unless the image is 8U, 16U or 32F with 1, 3 or 4 channels and finite.
void checkImage(const Mat& image);

/** An image as a grey map. 8U and 16U stay what they are; 32F is cut into 65535 steps between its minimum and its
 maximum, so that a gain and an offset change nothing. */
Mat integerMap(const Mat& image);

//! Throws unless position and size of every keypoint are finite and the size is positive.
void checkKeyPoints(const std::vector<KeyPoint>& keypoints);

}  // namespace iib
}  // namespace cv
