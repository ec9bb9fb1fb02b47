// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#pragma once

#include "opencv2/iib.hpp"
#include "opencv2/imgproc.hpp"
#include "opencv2/ts.hpp"

#ifdef IIB_PERF_XFEATURES2D
#include "opencv2/xfeatures2d.hpp"
#endif

namespace opencv_test {
using namespace cv::iib;
using namespace perf;
}  // namespace opencv_test
