// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#ifndef OPENCV_IIB_DESCRIPTOR_DETECTOR_PROBE_HPP
#define OPENCV_IIB_DESCRIPTOR_DETECTOR_PROBE_HPP

#include "../precomp.hpp"

#include <atomic>

namespace cv {
namespace iib {

//! Finds nothing, and tells whether it was asked. May be asked from several threads.
class DetectorProbe CV_FINAL : public Feature2D
{
public:
    std::atomic<bool> called;

    DetectorProbe() : called(false) {}

    void detectAndCompute(
            InputArray, InputArray, std::vector<KeyPoint>& keypoints, OutputArray, bool) CV_OVERRIDE
    {
        called = true;
        keypoints.clear();
    }
};

}  // namespace iib
}  // namespace cv

#endif
