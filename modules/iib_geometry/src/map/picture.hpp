// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "opencv2/core.hpp"

namespace cv::iib {

//! An image in grey, reduced to 1024 pixels if its longer side has more, in which keypoints of the image are refined.
struct Picture
{
    Mat pixels;        //!< CV_8U
    double scale = 1;  //!< of its pixels by the image's
};

Picture pictureOf(const Mat& image);

//! Keypoints of two images that show the same, one for one, in pixels of the images.
struct KeypointPairs
{
    std::vector<KeyPoint> fixed, moved;
};

/** Moves the second keypoint of each pair to what the first one shows (refineMatches).
@return whether that was found; the others stay. */
std::vector<bool> refine(const Picture& fixed, const Picture& moved, KeypointPairs& pairs);

}  // namespace cv::iib
