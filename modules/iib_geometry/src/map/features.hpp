// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "map.hpp"
#include "opencv2/iib.hpp"

namespace cv::iib {

//! What is found in an image: it has no name, camera and pose, and sees no points yet.
typedef MapImage Features;

//! What finds and describes the points of a map: createRecommended, or the paper's points and descriptor.
Ptr<IIB> describerOf(bool orbAndAkaze, int points);

inline void extract(IIB& iib, const Mat& image, const Mat& mask, Features& features)
{
    std::vector<KeyPoint> keypoints;
    iib.detectAndCompute(image, mask, keypoints, features.codes);
    for (const KeyPoint& k : keypoints)
    {
        features.pixels.emplace_back(k.pt);
        features.sizes.push_back(k.size);
    }
    features.sees.assign(keypoints.size(), -1);
    features.misses.assign(keypoints.size(), 0);
    features.picture = pictureOf(image);
}

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
