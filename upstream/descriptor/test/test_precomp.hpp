// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#pragma once

#include "opencv2/iib.hpp"
#include "opencv2/ts.hpp"

namespace opencv_test {
using namespace cv::iib;
}

/*
The descriptor once more, from the paper's equations and the header's words: pixel by pixel, cell by
cell, bit by bit. The tests ask the library for the same bits.
*/
namespace oracle {

//! atan2(-gy, gx) in 1024 steps a turn, with the library's polynomial.
int orientation(int gx, int gy);

//! keypoints.size() descriptors of a grey image.
cv::Mat describe(const cv::iib::IIBDescriptorExtractor& iib, const cv::Mat& grey,
        const std::vector<cv::KeyPoint>& keypoints);

}  // namespace oracle
