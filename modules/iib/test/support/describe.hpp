// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#pragma once

#include "test_images.hpp"

namespace opencv_test {

using cv::iib::IIB;

//! Computes descriptors and expects that the keypoints stay as they are.
Mat describe(IIB& iib, InputArray image, const std::vector<KeyPoint>& keypoints,
        InputArrayOfArrays extra = noArray());

//! Describes the keypoints as the oracle does, and expects the same bits.
void expectOracle(IIB& iib, const Mat& image, const std::vector<KeyPoint>& keypoints,
        const std::vector<Mat>& extra = std::vector<Mat>());

//! Counts of matchDetected().
struct DetectedMatches
{
    size_t keypoints[2];
    size_t matches;
    int correct;
};

//! Detects up to `most` points in both images, describes them with the detector's scale factor, matches mutually.
DetectedMatches matchDetected(const Ptr<Feature2D>& detector, const Mat images[2], int most);

}  // namespace opencv_test
