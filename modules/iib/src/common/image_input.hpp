// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#pragma once

#include "../precomp.hpp"

namespace cv { namespace iib {

/* Checks of users' images, and their conversion to single-channel integer maps (CV_8U or CV_16U). */

//! Throws unless the pixels are 8U, 16U or 32F and finite; `what` names the image in the message.
void checkPixels(const Mat& m, const String& what);

//! Throws unless the image is 8U, 16U or 32F with 1, 3 or 4 channels and finite.
void checkImage(const Mat& image);

/** The grey of a BGR or BGRA image of 8U or 16U: (3735 B + 19235 G + 9798 R + 2^14) >> 15, as cvtColor in OpenCV 4.6.
 cvtColor itself differs between versions and hardware layers (HAL). */
Mat greyOf(const Mat& image);

/** An image as a grey map. Colour of 8U and 16U goes through greyOf(). 32F is quantized to 65535 steps between its minimum
 and maximum, so that a gain and an offset change nothing. */
Mat integerMap(const Mat& image);

//! Throws unless every keypoint has a finite position and a finite, positive size. @param withAngles check angles too.
void checkKeyPoints(const std::vector<KeyPoint>& keypoints, bool withAngles);

//! The position of a match's keypoint; throws if the image, 1 or 2, has no such keypoint or its position is not finite.
Point2d positionOf(const std::vector<KeyPoint>& keypoints, int index, int image);

//! Base of detectors that take every image that passes checkImage().
struct AnyImage
{
    virtual ~AnyImage() {}
};

/** An image for a detector. 16U and 32F, which most detectors of OpenCV refuse or misread, become 8-bit grey, stretched from
 the image's minimum to its maximum, except for detectors of type AnyImage. Throws as checkImage(). */
Mat imageFor(const Feature2D& detector, const Mat& image);

/** A mask with 255 where it is not 0: some detectors scale masks and would lose a 1.
 @throws cv::Exception unless it is empty or CV_8UC1 of the image's size. */
Mat maskFor(InputArray mask, Size imageSize);

}}  // namespace cv::iib
