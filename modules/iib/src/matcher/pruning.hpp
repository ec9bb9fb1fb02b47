// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#ifndef OPENCV_IIB_MATCHER_PRUNING_HPP
#define OPENCV_IIB_MATCHER_PRUNING_HPP

#include "kernels/hamming.hpp"

namespace cv {
namespace iib {

//! A pair within `radius` is found; levels whose sum is beyond it end the comparison.
PruningPolicy radiusPolicy(const CodeLayout& layout, int radius);
//! The paper's rule; one threshold for each level but the last.
PruningPolicy thresholdPolicy(const CodeLayout& layout, const std::vector<float>& thresholds);
//! Bounds relative to the query's least distances so far.
PruningPolicy adaptivePolicy(const CodeLayout& layout);

}  // namespace iib
}  // namespace cv

#endif
