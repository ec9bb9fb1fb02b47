// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#pragma once

#include "knn_table.hpp"
#include "packed_codes.hpp"

namespace cv {
namespace iib {

//! Work of a search, in bits.
struct SearchCost
{
    SearchCost() : compared(0), all(0) {}
    SearchCost& operator+=(const SearchCost& other)
    {
        compared += other.compared;
        all += other.all;
        return *this;
    }
    uint64 compared, all;
};

/** How many queries and CodeBlocks of train codes are scanned at once. The train codes of 170 bytes fill 352 KB, so that
they stay in a second-level cache of 512 KB while the queries, 704 KB, pass by. Tests take fewer, so that small data
crosses the boundaries. */
struct ScanBlocks
{
    ScanBlocks() : queryCount(4096), codeBlocks(128), codeBlocksOfLimits(PruningPolicy::CODE_BLOCKS_OF_LIMITS)
    {
    }
    virtual ~ScanBlocks() {}
    //! CodeBlocks that are scanned at once by a policy.
    int codeBlocksFor(const PruningPolicy& policy) const
    {
        return policy.margin >= 0 ? codeBlocksOfLimits : codeBlocks;
    }
    int queryCount, codeBlocks, codeBlocksOfLimits;
};

//! What a search looks for and among which pairs.
struct SearchInput
{
    SearchInput(const PackedCodes& trains_, const Mat& queries_, const PruningPolicy& policy_,
            const std::vector<Mat>& masks_, const ScanBlocks& blocks_ = ScanBlocks())
        : trains(trains_), queries(queries_), policy(policy_), masks(masks_), blocks(blocks_), hidden(0),
          firstIndex(0)
    {
    }

    const PackedCodes& trains;
    const Mat& queries;             //!< CV_8U, as wide as the train codes
    const PruningPolicy& policy;    //!< made for the layout of the train codes
    const std::vector<Mat>& masks;  //!< none, or one for each image, empty or queries x rows(image)
    ScanBlocks blocks;
    const std::vector<bool>* hidden;  //!< of each image, whether its rows are left out; null: none is
    size_t firstIndex;                //!< what the first of the train codes is called in results
};

/* Searches run on several threads; results do not depend on their number. */

/** Finds the k nearest for each query; with `mutual`, only pairs that are among the k nearest in both directions. A row
stays empty unless its least distance is below maxRatio times the second, if that is under 1. */
KnnTable findNearest(const SearchInput& input, int k, bool mutual, float maxRatio, SearchCost& cost);

//! Puts the nearest of each query into a table, which may hold some of other train codes, of lower indices, already.
SearchCost addNearest(const SearchInput& input, KnnTable& forQueries);

//! Finds all within a radius, in ascending order for each query.
std::vector<std::vector<MatchKey>> findWithin(const SearchInput& input, int radius, SearchCost& cost);

/* Where comparisons may end: pruning.cpp. */

//! A pair within `radius` is found; levels whose sum is beyond it end the comparison.
PruningPolicy radiusPolicy(const CodeLayout& layout, int radius);
//! The paper's rule; one threshold for each level but the last.
PruningPolicy thresholdPolicy(const CodeLayout& layout, const std::vector<float>& thresholds);
//! Bounds relative to the query's least distances so far.
PruningPolicy adaptivePolicy(const CodeLayout& layout);

/* One pass over all pairs of some queries with all train codes, block by block, on one thread: pair_scan.cpp. */

//! Puts the nearest into tables of all queries and of all train codes; forTrains is null when nobody asks for that
//! direction, and else has room for whole CodeBlocks.
SearchCost scanNearest(
        const SearchInput& input, const Range& queries, KnnTable& forQueries, KnnTable* forTrains);

//! Adds the pairs within a radius to the list of each query, in the order of train codes.
SearchCost scanWithin(const SearchInput& input, const Range& queries, int radius,
        std::vector<std::vector<MatchKey>>& lists);

}  // namespace iib
}  // namespace cv
