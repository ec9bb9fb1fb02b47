// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#pragma once

#include "opencv2/iib/detail/packed_codes.hpp"

#include <algorithm>
#include <climits>
#include <functional>
#include <vector>

namespace cv { namespace iib {

//! A neighbour as one number: the distance above INDEX_BITS of index, so that ties go to the lowest index.
typedef uint64 MatchKey;
const MatchKey NO_MATCH = ~(MatchKey)0;

static inline MatchKey matchKey(int distance, size_t index)
{
    return (MatchKey)distance << INDEX_BITS | index;
}
static inline int distanceOf(MatchKey n) { return (int)(n >> INDEX_BITS); }
static inline size_t indexOf(MatchKey n) { return (size_t)(n & (((MatchKey)1 << INDEX_BITS) - 1)); }

//! The pairs of a scan: some queries with some train codes.
struct CodePairs
{
    int blocks() const
    {
        return (trainCount + CodeLayout::CODES_PER_BLOCK - 1) / CodeLayout::CODES_PER_BLOCK;
    }
    //! Train codes, including the padding of the last block.
    int paddedTrains() const { return blocks() * CodeLayout::CODES_PER_BLOCK; }

    const CodeLayout& layout;
    Mat queries;             //!< descriptors, a row each
    const unsigned* trains;  //!< packed, in CodeBlocks
    int trainCount;
    const uchar* allowed;  //!< queries.rows x paddedTrains(), 0 for masked pairs; null: no pair is masked
};

//! Finds the nearest or the two nearest train codes of each query. Only for pairs that fits() accepts.
struct NearestScan
{
    static constexpr int SMALL_INDEX_BITS = 12;  //!< of the 31 bits that index and distance share
    //! Whether indices and distances are small enough.
    static bool fits(const CodePairs& pairs)
    {
        return std::max(pairs.queries.rows, pairs.blocks()) <= 1 << SMALL_INDEX_BITS &&
               pairs.layout.bytes() < 1 << (31 - SMALL_INDEX_BITS - 3);
    }
    CodePairs pairs;
    MatchKey* ofQueries;  //!< nearest neighbours of each query so far, ascending; the scan updates them
    int count;            //!< neighbours per query, 1 or 2
    MatchKey* ofTrains;   //!< nearest query of each train code so far; null: not needed
    size_t firstQuery, firstTrain;  //!< added to indices in keys
};

//! A point within codes at which a scan may drop a pair.
struct PruneStage
{
    static constexpr int NO_MAX = 1 << 28;
    int words;  //!< compared before it, an odd number; more than at the stage before
    int most;   //!< largest number of differing bits since the stage before
};

//! Rules by which a scan drops pairs on the way from coarse to fine. Without stages, all are compared to the end.
struct PruningPolicy
{
    //! With a margin, limits are lowered after each 128 CodeBlocks (2048 train codes). Results of ADAPTIVE depend on
    //! this number, so it must not be tuned for speed.
    static constexpr int CODE_BLOCKS_OF_LIMITS = 128;

    std::vector<PruneStage> stages;
    int limit = INT_MAX;  //!< with a single stage: largest partial distance there
    int margin = -1;      //!< if >= 0, lowers a query's limit to its least partial distance plus this
};

//! Receives a pair of a scan. Indices count from the scan's first query and train code.
typedef std::function<void(int query, int train, int distance)> PairReport;

//! Finds all pairs that are below the threshold of the query or of the train code, and that no stage drops.
struct PrunedScan
{
    CodePairs pairs;
    const PruningPolicy& policy;
    const int* queryThresholds;  //!< calls of `found` may lower them
    const int* trainThresholds;  //!< of each train code, with room for whole CodeBlocks; or null
    const PairReport& found;
    int64* passed;  //!< for each stage, the scan adds the pairs that pass it
    int* limits;    //!< with a single stage, PruningPolicy::limit of each query; else null
};

/** The scans of one instruction set, and the packing of train codes that they need.

Train codes come in ascending order for each query, and queries for each train code, so that ties go to the lowest
index. Results do not depend on the instruction set. */
struct HammingKernels
{
    CodePacking packing;
    void (*nearest)(const NearestScan& scan);
    void (*pruned)(const PrunedScan& scan);
    const char* instructionSet;
};

//! The kernels of the widest instruction set. cv::setUseOptimized changes the result: keep it with the packed codes.
const HammingKernels& hammingKernels();

}}  // namespace cv::iib
