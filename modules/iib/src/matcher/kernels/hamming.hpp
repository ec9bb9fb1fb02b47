// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#pragma once

#include "opencv2/iib/detail/code_layout.hpp"

#include <algorithm>
#include <climits>
#include <vector>

namespace cv { namespace iib {

//! A neighbour as one number: distance above, INDEX_BITS of index below, so that ties go to the lowest index.
typedef uint64 MatchKey;
const MatchKey NO_MATCH = ~(MatchKey)0;

static inline MatchKey matchKey(int distance, size_t index)
{
    return (MatchKey)distance << INDEX_BITS | index;
}
static inline int distanceOf(MatchKey n) { return (int)(n >> INDEX_BITS); }
static inline size_t indexOf(MatchKey n) { return (size_t)(n & (((MatchKey)1 << INDEX_BITS) - 1)); }

//! The pairs that a scan compares: some queries with some train codes.
struct CodePairs
{
    int blocks() const
    {
        return (trainCount + CodeLayout::CODES_PER_BLOCK - 1) / CodeLayout::CODES_PER_BLOCK;
    }
    //! Train codes and what fills their last block up.
    int paddedTrains() const { return blocks() * CodeLayout::CODES_PER_BLOCK; }

    const CodeLayout& layout;
    Mat queries;             //!< descriptors, a row each
    const unsigned* trains;  //!< packed, in CodeBlocks
    int trainCount;
    const uchar* allowed;  //!< queries.rows x paddedTrains(), 0 for pairs that are masked; null: none is
};

//! Finds the nearest or the two nearest train codes of each query. Only for pairs that fit.
struct NearestScan
{
    static constexpr int SMALL_INDEX_BITS = 12;  //!< of the 31 that index and distance share
    //! Whether there are few enough of them, of codes short enough.
    static bool fits(const CodePairs& pairs)
    {
        return std::max(pairs.queries.rows, pairs.blocks()) <= 1 << SMALL_INDEX_BITS &&
               pairs.layout.bytes() < 1 << (31 - SMALL_INDEX_BITS - 3);
    }
    CodePairs pairs;
    MatchKey* ofQueries;  //!< the nearest of each so far in ascending order, which nearer ones replace
    int count;            //!< of these, a query: 1 or 2
    MatchKey* ofTrains;   //!< the nearest query of each train code so far; null: not wanted
    size_t firstQuery, firstTrain;  //!< the first indices in keys
};

//! Takes the pairs that a scan finds: those whose distance is below the threshold of the query or of the train code.
struct HammingSink
{
    //! The thresholds of train codes have room for whole CodeBlocks, or are null.
    HammingSink(const int* queryThresholds_, const int* trainThresholds_)
        : queryThresholds(queryThresholds_), trainThresholds(trainThresholds_)
    {
    }
    virtual ~HammingSink() {}
    //! Indices count from the first of the scan. May lower the thresholds.
    virtual void found(int query, int train, int distance) = 0;

    const int* const queryThresholds;
    const int* const trainThresholds;
};

//! Where a scan may give a pair up: later than at the stage before, and before the end.
struct PruneStage
{
    static constexpr int NO_MAX = 1 << 28;
    int words;  //!< of a code, an odd number
    int most;   //!< bits that may differ since the stage before
};

//! Where pairs are given up on the way from coarse to fine; without stages, never.
struct PruningPolicy
{
    //! With a margin, limits are lowered after each 128 CodeBlocks (2048 train codes). ADAPTIVE's answers depend on
    //! this number, so it must not be tuned for speed.
    static constexpr int CODE_BLOCKS_OF_LIMITS = 128;

    std::vector<PruneStage> stages;
    int limit = INT_MAX;  //!< with a single stage, the most bits that may differ there
    //! If >= 0, the limit of a query is lowered to its least difference at the stage plus this.
    int margin = -1;
};

//! Finds all pairs that are near enough and that no stage gives up. Without stages, all are compared to the end.
struct PrunedScan
{
    CodePairs pairs;
    const PruningPolicy& policy;
    HammingSink& sink;
    int64* passed;  //!< for each stage: adds up the pairs that went on there
    int* limits;    //!< with a single stage, the most bits of each query that may differ there; else null
};

/** The scans of one instruction set, and how they want their train codes packed: both belong together.

Train codes come in ascending order for each query, and queries for each train code, so that ties go to the lowest
index. What is found does not depend on the instruction set. */
struct HammingKernels
{
    CodePacking packing;
    void (*nearest)(const NearestScan& scan);
    void (*pruned)(const PrunedScan& scan);
    const char* instructionSet;
};

//! Those of the widest instruction set at hand. cv::setUseOptimized changes the answer: keep it with the packed codes.
const HammingKernels& hammingKernels();

}}  // namespace cv::iib
