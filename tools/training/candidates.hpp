// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "opencv2/iib.hpp"

namespace iib_tools {

//! What a selection is drawn from.
struct PoolParameters
{
    int channels, mapping, granularity;  //!< as in IIBDescriptorExtractor::create
    float scale;  //!< side of the ROS in units of KeyPoint::size, which is the ROS of the evaluation's fixed points
    /** Where a level's quads begin, coarse first, the last number for all finer levels too: a sum of 1 (even rows and
    columns), 2 (even rows, odd columns), 4 (odd rows, even columns) and 8 (odd rows and columns). */
    std::vector<int> windows;
    int border;  //!< IIBDescriptorExtractor::Border of the regions that are trained on
};

//! What is chosen or not: one bit of a quad.
struct Candidate
{
    int quad;      //!< row of CandidatePool::quads
    int mask;      //!< the bit, as in setSelection
    int position;  //!< the same bit in a descriptor of the pool
};

//! All quads of an extractor, described at once.
struct CandidatePool
{
    cv::Mat_<int> quads;                                 //!< all of them, as setSelection takes them
    cv::Ptr<cv::iib::IIBDescriptorExtractor> extractor;  //!< with all of them selected
    std::vector<Candidate> candidates;                   //!< by level, then by place

    int level(const Candidate& candidate) const { return quads(candidate.quad, 0); }
    //! Same level, channel and bit, and the quads touch or overlap: such bits repeat each other.
    bool areNeighbours(const Candidate& a, const Candidate& b) const;
};

int countBits(int mask);

CandidatePool makePool(const PoolParameters& parameters);

//! The rows for setSelection, by level, channel and place, the chosen bits of a quad in one mask.
cv::Mat_<int> selectionOf(const CandidatePool& pool, const std::vector<int>& chosen);

//! The pool's extractor with that selection.
cv::Ptr<cv::iib::IIBDescriptorExtractor> selectedExtractor(
        const CandidatePool& pool, const std::vector<int>& chosen);

}  // namespace iib_tools
