// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "opencv2/iib.hpp"

namespace iib_localization {

//! What is found in an image, the strongest first.
struct Features
{
    std::vector<cv::Point2d> pixels;
    cv::Mat codes;  //!< a row each
};

inline Features extract(cv::iib::IIB& iib, const cv::Mat& image)
{
    Features features;
    std::vector<cv::KeyPoint> keypoints;
    iib.detectAndCompute(image, cv::noArray(), keypoints, features.codes);
    for (const cv::KeyPoint& k : keypoints)
        features.pixels.emplace_back(k.pt);
    return features;
}

}  // namespace iib_localization
