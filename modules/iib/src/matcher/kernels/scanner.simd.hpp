// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// What all scans share, the queries of a row of tiles and which pairs exist, and the scan of all pairs.

#ifndef OPENCV_IIB_MATCHER_KERNELS_SCANNER_SIMD_HPP
#define OPENCV_IIB_MATCHER_KERNELS_SCANNER_SIMD_HPP

#include "count_vectors.simd.hpp"
#include "hamming.hpp"

// Tile compares some queries with a CodeBlock, TileQueries prepares these queries, PACKING is the packing that both
// understand: by tables in registers where bytes are looked up faster than the bits of words are counted, else by adders.
#if IIB_LOOKS_UP_16 && !IIB_COUNTS_LANES
#include "tile_tables.simd.hpp"
#else
#include "tile_adders.simd.hpp"
#endif

namespace cv {
namespace iib {
CV_CPU_OPTIMIZATION_NAMESPACE_BEGIN
namespace {

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
        {
            layout.arrange(pairs.queries.ptr(query + q), plain.data() + q * layout.words());
            queries.set(q, plainQuery(q));
        }
    }
    //! The plain words of one of the queries that were set.
    const unsigned* plainQuery(int q) const { return plain.data() + q * layout.words(); }

    //! Whether missing() has to be asked.
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
    TileQueries queries;
    const int blocks;

private:
    AutoBuffer<unsigned> plain;
};

//! Hands pairs that are near enough to a sink.
class SinkScanner : public Scanner
{
public:
    SinkScanner(const CodePairs& p, HammingSink& s) : Scanner(p), sink(s) {}

protected:
    //! Negative where a distance is small enough to be found.
    CV_ALWAYS_INLINE Counts slack(int query, int block, int v, const Counts& distance) const
    {
        Counts threshold = vx_setall_s32(sink.queryThresholds[query]);
        if (sink.trainThresholds)
            threshold = v_max(threshold, vx_load(sink.trainThresholds + block * CODES_PER_BLOCK + v * WIDTH));
        return distance - threshold;
    }

    //! Hands on the pairs whose slack is negative.
    void collect(int query, int block, const Counts* distances, const Counts* slacks)
    {
        int lanes = negativeLanes(slacks);
        if (!lanes)
            return;
        if (incomplete(block))
        {
            Counts missed[VECTORS];
            for (int v = 0; v < VECTORS; v++)
                missed[v] = missing(query, block, v);
            lanes &= ~negativeLanes(missed);
        }
        int near[CODES_PER_BLOCK];
        storeLanes(near, distances, lanes);
        for (int i = 0; lanes; lanes &= lanes - 1)
            sink.found(query, block * CODES_PER_BLOCK + trailingZeros32(lanes), near[i++]);
    }

    HammingSink& sink;
};

//! Exhaustive scan; skips the rest of a tile once no pair in it can qualify.
class FullScanner : public SinkScanner
{
public:
    FullScanner(const CodePairs& p, HammingSink& s) : SinkScanner(p, s), early(layout.words())
    {
        // In both directions some pair is nearly always near enough. PACKING_ADDERS wants an odd number.
        if (!s.trainThresholds && layout.bytes() > 64)
            early = layout.words() * 7 / 10 | 1;
    }

    //! Some queries against all blocks.
    template <int Q> void row(int query)
    {
        setQueries<Q>(query);
        // A look costs about a sixth of what an early end saves: stop looking where too few tiles end early.
        for (int block = 0, ended = 0; block < blocks; block++)
            ended += compare<Q>(query, block, block <= 8 + 6 * ended ? early : layout.words());
    }

private:
    //! Returns whether the tile ended after `end` words, before the last.
    template <int Q> CV_ALWAYS_INLINE bool compare(int query, int block, int end)
    {
        Tile<Q> tile;
        Counts distance[Tile<Q>::SIZE], slacks[Tile<Q>::SIZE];
        tile.start(queries, codes(block), end);
        bool near = anyNear<Q>(tile, query, block, distance, slacks);
        if (end < layout.words())
        {
            if (!near)
                return true;
            tile.advance(queries, codes(block), end, layout.words());
            near = anyNear<Q>(tile, query, block, distance, slacks);
        }
        for (int q = 0; q < Q && near; q++)
            collect(query + q, block, distance + q * VECTORS, slacks + q * VECTORS);
        return false;
    }

    template <int Q>
    CV_ALWAYS_INLINE bool anyNear(
            const Tile<Q>& tile, int query, int block, Counts* distance, Counts* slacks) const
    {
        Counts any = vx_setzero_s32();
        tile.distances(distance);
        for (int i = 0; i < Tile<Q>::SIZE; i++)
        {
            slacks[i] = slack(query + i / VECTORS, block, i % VECTORS, distance[i]);
            any = any | slacks[i];
        }
        return v_check_any(any);
    }

    int early;  //!< words after which a tile may be left if no pair is near enough so far, since distances only grow
};

}  // namespace
CV_CPU_OPTIMIZATION_NAMESPACE_END
}  // namespace iib
}  // namespace cv

#endif
