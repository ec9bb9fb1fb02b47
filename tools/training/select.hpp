// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "candidates.hpp"
#include "samples.hpp"

namespace iib_tools {

/** Grows a selection for mutual matching. An anchor point has distance d0 from its partner, and d1..d15 from the
nearest other points of the partner's image. The model's probability of a right match is p = 1 / (1 + sum exp((d0 -
ratio dk) / T)), T = sqrt(bits) / 4. The loss 2 - 2 sqrt(p) gives hopeless points little weight. Each step draws new
anchors, finds the points with which the chosen bits confuse them, and adds the candidates along which the loss falls
fastest, but no neighbours in one step.

@return at most `bits` candidates, with a whole number of bytes a level.
@throws cv::Exception for too few pairs, or a pool of too few bits. */
std::vector<int> selectGreedily(const CandidatePool& pool, const std::vector<DescribedPair>& pairs, int bits,
        uint64 seed, const Progress& progress);

/** The paper's selection ("Reduction of the IIB Descriptor Size"): AdaBoost over whole quads of 4 bits. Half of the
samples are two views of one point, half are two different points. A weak learner says "same" if at most a threshold of
its quad's bits differ. Quads are kept in the order of AdaBoost.

@return at most bits / 4 whole quads, with a whole number of bytes a level.
@throws cv::Exception as selectGreedily, and for a mapping with quads of other sizes. */
std::vector<int> selectByAdaBoost(const CandidatePool& pool, const std::vector<DescribedPair>& pairs,
        int bits, uint64 seed, const Progress& progress);

/** Rounds each level to a whole number of bytes, to avoid padding: levels lose or gain candidates, those with the
largest benefit first, up to `bits` in all.
@param benefit of each candidate of the pool; candidates that are not chosen are added only if it is positive. */
std::vector<int> fillBytes(const CandidatePool& pool, const std::vector<int>& chosen,
        const std::vector<double>& benefit, int bits);

}  // namespace iib_tools
