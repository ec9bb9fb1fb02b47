// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#ifndef OPENCV_IIB_INDEX_TEST_PRECOMP_HPP
#define OPENCV_IIB_INDEX_TEST_PRECOMP_HPP

#include "opencv2/iib.hpp"
#include "opencv2/iib_index.hpp"
#include "opencv2/ts.hpp"

namespace opencv_test {
using cv::iib::HierarchicalMatcher;
using cv::iib::MappedIndex;
}  // namespace opencv_test

#endif
