// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "candidates.hpp"
#include "samples.hpp"

namespace iib_tools {

/** Grows a selection for mutual matching. An anchor point at distance d0 from its partner and d1..d15 from
its nearest other points of the same image is matched right with probability
p = 1 / (1 + sum exp((d0 - ratio dk) / T)), T = sqrt(bits) / 4; what is lost is 2 - 2 sqrt(p), which does not care
much for hopeless points. Each step draws fresh anchors, finds the points that the bits chosen so far confuse
them with, and takes those candidates along which the loss falls fastest, never two neighbours in one step.

@return that many candidates at most, every level a whole number of bytes.
@throws cv::Exception if the pairs are too few or the pool has too few bits. */
std::vector<int> selectGreedily(const CandidatePool& pool, const std::vector<DescribedPair>& pairs, int bits,
        uint64 seed, const Progress& progress);

/** The paper's selection ("Reduction of the IIB Descriptor Size"): AdaBoost over whole quads of 4 bits. A sample is two
points, the same one or two different ones of a pair, as many of each; a weak learner says "same" if at most so many bits
of its quad differ. Quads are kept in the order in which AdaBoost takes them.

@return whole quads, bits / 4 at most, every level a whole number of bytes.
@throws cv::Exception as selectGreedily, and for a mapping of other quads. */
std::vector<int> selectByAdaBoost(const CandidatePool& pool, const std::vector<DescribedPair>& pairs,
        int bits, uint64 seed, const Progress& progress);

/** Makes every level a whole number of bytes, so that no bit is padding: levels are rounded and then keep or
gain the candidates with the largest benefit, `bits` at most. `benefit` is one number a candidate of the pool; those that
are not chosen need a positive one. */
std::vector<int> fillBytes(const CandidatePool& pool, const std::vector<int>& chosen,
        const std::vector<double>& benefit, int bits);

}  // namespace iib_tools
