// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "camera.hpp"

namespace iib_localization {

//! The line segments of one image.
struct LineFeatures
{
    //! As seen, with distortion. The brighter side is always the same one, looking from begin to end.
    std::vector<Segment> segments;
    cv::Mat codes;  //!< LBD, a row of 32 bytes for each segment
};

//! False if this program was built without OpenCV's module line_descriptor: then no image has lines.
bool linesAvailable();

//! Finds segments of 20 pixels or more (LSD) and describes them (LBD).
LineFeatures extractLines(const cv::Mat& grey);

std::vector<Segment> undistorted(const std::vector<Segment>& segments, const Camera& camera);

}  // namespace iib_localization
