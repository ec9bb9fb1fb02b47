// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "opencv2/iib.hpp"

namespace iib_tools {

//! Parameters of the pool from which a selection is learned.
struct PoolParameters
{
    int channels, mapping, granularity;  //!< as in IIBDescriptorExtractor::create
    float scale;  //!< side of the ROS over KeyPoint::size, which is the ROS of the evaluation's fixed points
    /** Positions of each level's quads, coarse first; the last number holds for all finer levels. A sum of 1 (even rows
    and columns), 2 (even rows, odd columns), 4 (odd rows, even columns) and 8 (odd rows and columns). */
    std::vector<int> windows;
    int border;  //!< IIBDescriptorExtractor::Border of the training regions
};

//! One bit of a quad, which the selection may contain.
struct Candidate
{
    int quad;      //!< row of CandidatePool::quads
    int mask;      //!< the bit, as in setSelection
    int position;  //!< the same bit in a descriptor of the pool
};

//! All quads of an extractor, described at once.
struct CandidatePool
{
    cv::Mat_<int> quads;                                 //!< all quads, in the format of setSelection
    cv::Ptr<cv::iib::IIBDescriptorExtractor> extractor;  //!< with all quads selected
    std::vector<Candidate> candidates;                   //!< by level, then by position

    int level(const Candidate& candidate) const { return quads(candidate.quad, 0); }
    //! Whether level, channel and bit are equal and the quads touch or overlap: such bits are redundant.
    bool areNeighbours(const Candidate& a, const Candidate& b) const;
};

int countBits(int mask);

CandidatePool makePool(const PoolParameters& parameters);

//! The rows for setSelection, by level, channel and position, with one mask of the chosen bits a quad.
cv::Mat_<int> selectionOf(const CandidatePool& pool, const std::vector<int>& chosen);

//! The pool's extractor with that selection.
cv::Ptr<cv::iib::IIBDescriptorExtractor> selectedExtractor(
        const CandidatePool& pool, const std::vector<int>& chosen);

}  // namespace iib_tools
