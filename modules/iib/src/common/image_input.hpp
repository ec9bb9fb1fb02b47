// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#pragma once

#include "../precomp.hpp"

namespace cv { namespace iib {

/* Images that users pass, checked, as single-channel integer maps (CV_8U or CV_16U), on which all later decisions
 are exact. */

//! Throws unless the pixels are 8U, 16U or 32F and finite; `what` names the image in the message.
void checkPixels(const Mat& m, const String& what);

//! Throws unless the image is 8U, 16U or 32F with 1, 3 or 4 channels and finite.
void checkImage(const Mat& image);

/** The grey of a BGR or BGRA image of 8U or 16U: (3735 B + 19235 G + 9798 R + 2^14) >> 15, as cvtColor's in OpenCV 4.6.
 Not cvtColor itself, whose bits versions and hardware layers (HAL) change. */
Mat greyOf(const Mat& image);

/** An image as a grey map. 8U and 16U stay what they are, those in colour by greyOf(); 32F is cut into 65535 steps
 between its minimum and its maximum, so that a gain and an offset change nothing. */
Mat integerMap(const Mat& image);

//! Throws unless position and size of every keypoint are finite and the size is positive. @param withAngles whether
//! angles are used and so must be finite.
void checkKeyPoints(const std::vector<KeyPoint>& keypoints, bool withAngles);

//! The position of the keypoint that a match refers to; throws if there is none or it is not finite.
Point2d positionOf(const std::vector<KeyPoint>& keypoints, int index);

//! A base of detectors that take images of all types that checkImage() lets pass.
struct AnyImage
{
    virtual ~AnyImage() {}
};

/** An image as a detector takes it, to find keypoints or to describe them: 8U as it is; 16U and 32F, which most
 detectors of OpenCV refuse or read wrongly, as 8-bit grey from the image's own minimum to its maximum. Those of type
 AnyImage take all types. Throws as checkImage(). */
Mat imageFor(const Feature2D& detector, const Mat& image);

/** A detection's mask with 255 where it is not 0: detectors that scale it would lose a 1.
 @throws cv::Exception unless it is empty or CV_8UC1 of the image's size. */
Mat maskFor(InputArray mask, Size imageSize);

}}  // namespace cv::iib
