// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "opencv2/iib.hpp"
#include "opencv2/ts.hpp"

inline bool equal(const cv::Mat& a, const cv::Mat& b)
{
    return a.size() == b.size() && (a.empty() || cv::norm(a, b, cv::NORM_INF) == 0);
}

inline cv::Mat noise(cv::Size size, int type, int seed)
{
    cv::Mat image(size, type);
    cv::RNG(seed).fill(image, cv::RNG::UNIFORM, 0, CV_MAT_DEPTH(type) == CV_8U ? 256 : 65536);
    return image;
}
