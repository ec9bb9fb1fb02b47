// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#pragma once

#include "kernels/hamming.hpp"

#include <atomic>
#include <new>

namespace cv { namespace iib {

//! Bits compared by searches, and bits that brute force would compare.
struct SearchCost
{
    std::atomic<uint64> compared{0}, all{0};
};

/** Queries and CodeBlocks of train codes in a chunk. With 170 bytes a code, a chunk's train codes (352 KB) stay in a
second-level cache of 512 KB. Tests use smaller chunks. */
struct ScanChunk
{
    int queryCount = 4096, codeBlocks = 128, codeBlocksOfLimits = PruningPolicy::CODE_BLOCKS_OF_LIMITS;
};

struct SearchInput
{
    const PackedCodes& trains;
    Mat queries;               //!< CV_8U, as wide as the train codes
    PruningPolicy policy;      //!< made for the layout of the train codes
    std::vector<Mat> masks;    //!< none, or one for each image, empty or queries x rows(image)
    std::vector<bool> hidden;  //!< for each image, whether its rows are left out; empty: no image is
    size_t firstIndex;         //!< index of the first train code in results
    ScanChunk chunk;
    SearchCost& cost;  //!< the search adds to it
};

//! rows * k values; throws StsNoMem, with k in the message, if memory does not suffice.
template <typename T> std::vector<T> forNeighbours(size_t rows, int k, T value)
{
    try
    {
        if ((uint64)rows * k <= std::vector<T>().max_size())
            return std::vector<T>(rows * k, value);
    }
    catch (const std::bad_alloc&)
    {
    }
    CV_Error_(
            Error::StsNoMem, ("k is %d: memory does not hold as many neighbours of each of %llu descriptors",
                                     k, (unsigned long long)rows));
}

//! The k nearest neighbours of each code, in ascending order; NO_MATCH where there are fewer.
class KnnTable
{
public:
    //! @param padding further entries, since vectors read thresholds() past the end.
    KnnTable(size_t rows, int k_, size_t padding = 0)
        : k(k_), keys(forNeighbours(rows, k_, NO_MATCH)), nearest(rows + padding, INT_MAX)
    {
    }

    int size() const { return k; }
    size_t rows() const { return keys.size() / k; }
    MatchKey* operator[](size_t row) { return &keys[row * k]; }
    const MatchKey* operator[](size_t row) const { return &keys[row * k]; }
    //! The distance of each row's k-th neighbour: a further neighbour must be nearer.
    const int* thresholds() const { return nearest.data(); }
    int* thresholds() { return nearest.data(); }

    void insert(size_t row, MatchKey n)
    {
        MatchKey* first = (*this)[row];
        MatchKey* last = first + k - 1;
        if (n >= *last)
            return;
        MatchKey* place = std::upper_bound(first, last, n);
        std::copy_backward(place, last, last + 1);
        *place = n;
        if (*last != NO_MATCH)
            nearest[row] = distanceOf(*last);
    }

    void merge(const KnnTable& other)
    {
        for (size_t row = 0; row < rows(); row++)
            for (int i = 0; i < k; i++)
                insert(row, other[row][i]);
    }

private:
    int k;
    std::vector<MatchKey> keys;
    std::vector<int> nearest;
};

/* One pass of some queries over all train codes, chunk by chunk, on one thread. */

//! Adds the nearest to the tables of all queries and of all train codes (pair_scan.cpp). forTrains is null if that direction is not needed,
//! else it has room for whole CodeBlocks.
void scanNearest(const SearchInput& input, const Range& queries, KnnTable& forQueries, KnnTable* forTrains);

//! Adds the pairs within a radius to the list of each query, in the order of train codes.
void scanWithin(const SearchInput& input, const Range& queries, int radius,
        std::vector<std::vector<MatchKey>>& lists);

//! A mask for each image of the index, or none if all are empty; throws where one does not fit.
std::vector<Mat> checkedMasks(InputArrayOfArrays masks, int queries, const PackedCodes& index);

/** Throws StsOutOfRange if results of k columns would be large and mostly empty. @param rows number of train rows. */
void checkPadding(int k, size_t queries, size_t rows);

/* Searches run on several threads; results do not depend on their number. */

/** Finds the k nearest for each query; with `mutual`, only pairs that are among the k nearest in both directions. With
maxRatio < 1, a row stays empty unless its least distance is below maxRatio times the second. */
KnnTable findNearest(const SearchInput& input, int k, bool mutual, float maxRatio);

//! Adds the nearest of each query to a table, which may hold neighbours with lower indices already.
void addNearest(const SearchInput& input, KnnTable& forQueries);

//! Finds all within a radius, in ascending order for each query.
std::vector<std::vector<MatchKey>> findWithin(const SearchInput& input, int radius);

/* Rules that end comparisons early. */

//! Ends pairs whose partial distance exceeds the radius.
PruningPolicy radiusPolicy(const CodeLayout& layout, int radius);
//! The paper's rule; one threshold for each level but the last.
PruningPolicy thresholdPolicy(const CodeLayout& layout, const std::vector<float>& thresholds);
//! Limits relative to the query's least partial distance so far.
PruningPolicy adaptivePolicy(const CodeLayout& layout);

}}  // namespace cv::iib
