// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#pragma once

#include "opencv2/ts.hpp"
#include "opencv2/iib.hpp"

#if CV_VERSION_MAJOR >= 5
#include "opencv2/geometry.hpp"
#include "opencv2/xfeatures2d.hpp"
#endif

namespace opencv_test {
using namespace cv::iib;
#if CV_VERSION_MAJOR >= 5  // opencv_contrib has these since then
using cv::xfeatures2d::AgastFeatureDetector;
using cv::xfeatures2d::AKAZE;
using cv::xfeatures2d::BRISK;
using cv::xfeatures2d::KAZE;
#endif
}  // namespace opencv_test
