// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#pragma once

#include "../test_precomp.hpp"

namespace opencv_test {

//! Stores its image, and finds no keypoints.
class CaptureDetector : public Feature2D
{
public:
    using Feature2D::detect;
    void detect(InputArray image, std::vector<KeyPoint>& keypoints, InputArray) CV_OVERRIDE
    {
        image.copyTo(seen);
        keypoints.clear();
    }

    Mat seen;
};

//! The image that NormalizedDetector passes to its detector.
inline Mat normalized(InputArray image, float sigma)
{
    const Ptr<CaptureDetector> capture = makePtr<CaptureDetector>();
    std::vector<KeyPoint> keypoints;
    NormalizedDetector::create(capture, sigma)->detect(image, keypoints);
    return capture->seen;
}

}  // namespace opencv_test
