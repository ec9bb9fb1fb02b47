// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// The base of all scans, and the scan for the nearest codes.

#pragma once

#include "hamming.hpp"
#include "block_distances.simd.hpp"

namespace cv { namespace iib {
CV_CPU_OPTIMIZATION_NAMESPACE_BEGIN
namespace {

//! Prepares some queries, and says which pairs exist.
class Scanner
{
public:
    explicit Scanner(const CodePairs& p)
        : pairs(p), layout(p.layout), queries(layout), blocks(p.blocks()), plain(QUERIES * layout.words())
    {
    }

protected:
    template <int Q> void setQueries(int query)
    {
        for (int q = 0; q < Q; q++)
            layout.arrange(pairs.queries.ptr(query + q), plain.data() + q * layout.words());
        queries.set<Q>(plain.data());
    }
    //! The plain words of query q of setQueries().
    const unsigned* plainQuery(int q) const { return plain.data() + q * layout.words(); }

    //! Whether missing() may be negative.
    bool incomplete(int block) const { return pairs.allowed || block == blocks - 1; }
    //! Negative in the lanes whose pairs do not exist or are masked.
    CV_ALWAYS_INLINE Counts missing(int query, int block, int v) const
    {
        Counts result = vx_setzero_s32();
        if (block == blocks - 1)
            result =
                    vx_setall_s32(pairs.trainCount - 1 - block * CODES_PER_BLOCK - v * WIDTH) - laneNumbers();
        if (pairs.allowed)
        {
            const uchar* allowed = pairs.allowed + ((size_t)query * blocks + block) * CODES_PER_BLOCK;
            result = result |
                     (v_reinterpret_as_s32(vx_load_expand_q(allowed + v * WIDTH)) == vx_setzero_s32());
        }
        return result;
    }

    const unsigned* codes(int block) const { return pairs.trains + block * layout.blockWords(); }

    const CodePairs& pairs;
    const CodeLayout& layout;
    QueryGroup queries;
    const int blocks;

private:
    AutoBuffer<unsigned> plain;
};

/** The COUNT nearest of each query and, if needed, the nearest of each train code. A pair's key is its distance, followed by
an index in the low bits: the least key is that of the nearest pair, ties to the first. So no result needs a branch. */
template <int COUNT> class NearestScanner : public Scanner
{
public:
    explicit NearestScanner(const NearestScan& s)
        : Scanner(s.pairs), scan(s), trains(s.ofTrains ? s.pairs.paddedTrains() : 0), trainKeys(trains)
    {
        std::fill(trainKeys.data(), trainKeys.data() + trains, int(NO_KEY));
    }

    //! Compares Q queries with all blocks.
    template <int Q> void row(int query)
    {
        setQueries<Q>(query);
        Counts nearest[COUNT][BlockDistances<Q>::SIZE];
        for (int i = 0; i < COUNT * BlockDistances<Q>::SIZE; i++)
            nearest[i / BlockDistances<Q>::SIZE][i % BlockDistances<Q>::SIZE] = vx_setall_s32(NO_KEY);
        for (int block = 0; block < blocks; block++)
            compare<Q>(query, block, nearest);
        for (int n = 0; n < COUNT; n++)
            for (int i = 0; i < BlockDistances<Q>::SIZE; i++)
                keepOfQuery(query + i / VECTORS, i % VECTORS * WIDTH, nearest[n][i]);
    }

    //! After the last row.
    void keepOfTrains() const
    {
        for (int train = 0; trains > 0 && train < pairs.trainCount; train++)
            keep(scan.ofTrains + train, 1, trainKeys.data()[train],
                    scan.firstQuery + (trainKeys.data()[train] & INDEX_MASK));
    }

private:
    static constexpr int BITS = NearestScan::SMALL_INDEX_BITS, INDEX_MASK = (1 << BITS) - 1, NO_KEY = INT_MAX;

    template <int Q>
    CV_ALWAYS_INLINE void compare(int query, int block, Counts (&nearest)[COUNT][BlockDistances<Q>::SIZE])
    {
        BlockDistances<Q> tile;
        Counts keys[BlockDistances<Q>::SIZE];
        tile.start(queries, codes(block), layout.words());
        tile.distances(keys);
        for (int i = 0; i < BlockDistances<Q>::SIZE; i++)
            keys[i] = keys[i] << BITS;
        if (incomplete(block))
            for (int i = 0; i < BlockDistances<Q>::SIZE; i++)
                keys[i] = v_select(missing(query + i / VECTORS, block, i % VECTORS) < vx_setzero_s32(),
                        vx_setall_s32(NO_KEY), keys[i]);
        for (int i = 0; i < BlockDistances<Q>::SIZE; i++)
        {
            const Counts key = keys[i] | vx_setall_s32(block);
            if (COUNT > 1)
                nearest[COUNT - 1][i] = v_min(nearest[COUNT - 1][i], v_max(nearest[0][i], key));
            nearest[0][i] = v_min(nearest[0][i], key);
        }
        for (int v = 0; v < VECTORS && trains > 0; v++)
        {
            int* const ofTrains = trainKeys.data() + block * CODES_PER_BLOCK + v * WIDTH;
            Counts least = vx_load(ofTrains);
            for (int q = 0; q < Q; q++)
                least = v_min(least, keys[q * VECTORS + v] | vx_setall_s32(query + q));
            v_store(ofTrains, least);
        }
    }

    void keepOfQuery(int query, int firstLane, const Counts& keys) const
    {
        int all[WIDTH];
        v_store(all, keys);
        for (int lane = 0; lane < WIDTH; lane++)
            keep(scan.ofQueries + (size_t)query * COUNT, COUNT, all[lane],
                    scan.firstTrain + (all[lane] & INDEX_MASK) * CODES_PER_BLOCK + firstLane + lane);
    }

    //! Inserts a pair into the `count` nearest ones.
    static void keep(MatchKey* nearest, int count, int key, size_t index)
    {
        MatchKey n = key == NO_KEY ? NO_MATCH : matchKey(key >> BITS, index);
        for (int i = 0; i < count; i++)
        {
            const MatchKey before = nearest[i];
            nearest[i] = std::min(before, n);
            n = std::max(before, n);
        }
    }

    const NearestScan& scan;
    const int trains;  // 0 if only queries have neighbours
    AlignedBuffer<int> trainKeys;
};

}  // namespace
CV_CPU_OPTIMIZATION_NAMESPACE_END
}}  // namespace cv::iib
