// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#ifndef OPENCV_IIB_MATCHER_PRUNING_HPP
#define OPENCV_IIB_MATCHER_PRUNING_HPP

#include "kernels/hamming.hpp"

#include <climits>
#include <vector>

namespace cv {
namespace iib {

//! Where pairs are given up on the way from coarse to fine; without stages, never.
struct PruningPolicy
{
    //! With a margin, this many CodeBlocks of train codes, 2048 codes, are compared before limits come down. It is part of
    //! ADAPTIVE's answers, and so not to be changed for speed.
    static constexpr int CODE_BLOCKS_OF_LIMITS = 128;

    std::vector<PruneStage> stages;
    int limit;   //!< with a single stage, the most bits that may differ there
    int margin;  //!< if >= 0, the limit of a query comes down to its least difference there plus this

    PruningPolicy() : limit(INT_MAX), margin(-1) {}
};

//! A pair within `radius` is found; levels whose sum is beyond it end the comparison.
PruningPolicy radiusPolicy(const CodeLayout& layout, int radius);
//! The paper's rule; one threshold for each level but the last.
PruningPolicy thresholdPolicy(const CodeLayout& layout, const std::vector<float>& thresholds);
//! Bounds relative to the query's least distances so far.
PruningPolicy adaptivePolicy(const CodeLayout& layout);

}  // namespace iib
}  // namespace cv

#endif
