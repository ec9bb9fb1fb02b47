// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "opencv2/iib.hpp"
#include "opencv2/iib_index.hpp"
#include "opencv2/ts.hpp"

namespace opencv_test {
using cv::iib::HierarchicalMatcher;
using cv::iib::MappedIndex;
}  // namespace opencv_test
