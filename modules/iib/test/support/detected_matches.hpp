// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#ifndef OPENCV_IIB_TEST_SUPPORT_DETECTED_MATCHES_HPP
#define OPENCV_IIB_TEST_SUPPORT_DETECTED_MATCHES_HPP

#include "test_images.hpp"

namespace opencv_test {

//! What matching two images of the same view gave.
struct DetectedMatches
{
    size_t keypoints[2];
    size_t matches;
    int correct;  //!< at most 3 pixels from where the point is in the first image
};

//! Detects up to `most` points in both images, describes them with the detector's scale factor, matches mutually.
DetectedMatches matchDetected(const Ptr<Feature2D>& detector, const Mat images[2], int most);

}  // namespace opencv_test

#endif
