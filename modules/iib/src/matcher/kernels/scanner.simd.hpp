// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// What all scans share: which pairs exist and are near enough, and where found pairs go.

#ifndef OPENCV_IIB_MATCHER_KERNELS_SCANNER_SIMD_HPP
#define OPENCV_IIB_MATCHER_KERNELS_SCANNER_SIMD_HPP

#include "hamming.hpp"
#include "tile.simd.hpp"

namespace cv {
namespace iib {
CV_CPU_OPTIMIZATION_NAMESPACE_BEGIN
namespace {

//! Hands found pairs to a sink.
class SinkCollector
{
public:
    explicit SinkCollector(HammingSink& s)
        : queryThresholds(s.queryThresholds), trainThresholds(s.trainThresholds), sink(s)
    {
    }
    //! Takes the pairs of a query and of some codes of a block, whose first is `train`.
    void collect(int query, int train, const Counts* distances, int lanes)
    {
        int near[CODES_PER_BLOCK];
        storeLanes(near, distances, lanes);
        for (int i = 0; lanes; lanes &= lanes - 1)
            sink.found(query, train + trailingZeros32(lanes), near[i++]);
    }

    const int* const queryThresholds;
    const int* const trainThresholds;

private:
    HammingSink& sink;
};

//! Keeps the nearest of each query and, if wanted, of each train code.
class NearestCollector
{
public:
    explicit NearestCollector(const NearestScan& s)
        : queryThresholds(s.ofQueries.distances), trainThresholds(s.ofTrains.distances),
          ofQueries(s.ofQueries), ofTrains(s.ofTrains)
    {
    }
    void collect(int query, int train, const Counts* distances, int lanes)
    {
        int near[CODES_PER_BLOCK];
        for (int v = 0; v < VECTORS; v++)
            v_store(near + v * WIDTH, distances[v]);
        for (; lanes; lanes &= lanes - 1)
        {
            const int lane = trailingZeros32(lanes);
            keep(ofQueries, query, near[lane], train + lane);
            if (trainThresholds)
                keep(ofTrains, train + lane, near[lane], query);
        }
    }

    const int* const queryThresholds;
    const int* const trainThresholds;

private:
    static void keep(const NearestCodes& nearest, int i, int distance, int index)
    {
        if (distance >= nearest.distances[i])
            return;
        nearest.distances[i] = distance;
        nearest.indices[i] = index;
    }

    const NearestCodes ofQueries, ofTrains;
};

template <class Collector> class Scanner
{
public:
    Scanner(const CodePairs& p, const Collector& c)
        : pairs(p), layout(p.layout), queries(layout), collector(c), blocks(p.blocks()),
          lastLanes(ALL_LANES >> (p.paddedTrains() - p.trainCount))
    {
    }

protected:
    template <int Q> void setQueries(int query)
    {
        for (int q = 0; q < Q; q++)
            queries.set(q, plainQuery(query + q));
    }

    //! Negative where a distance is small enough to be found.
    CV_ALWAYS_INLINE Counts slack(int query, int block, int v, const Counts& distance) const
    {
        Counts threshold = vx_setall_s32(collector.queryThresholds[query]);
        if (collector.trainThresholds)
            threshold = v_max(
                    threshold, vx_load(collector.trainThresholds + block * CODES_PER_BLOCK + v * WIDTH));
        return distance - threshold;
    }

    //! Collects the pairs whose slack is negative.
    void collect(int query, int block, const Counts* distances, const Counts* slacks)
    {
        int lanes = negativeLanes(slacks);
        if (!lanes)
            return;
        if (pairs.allowed || block == blocks - 1)
            lanes &= existing(query, block);
        collector.collect(query, block * CODES_PER_BLOCK, distances, lanes);
    }

    //! The lanes whose pairs exist and are not masked.
    int existing(int query, int block) const
    {
        const int lanes = block == blocks - 1 ? lastLanes : ALL_LANES;
        if (!pairs.allowed)
            return lanes;
        const uchar* allowed = pairs.allowed + ((size_t)query * blocks + block) * CODES_PER_BLOCK;
        Counts masked[VECTORS];
        for (int v = 0; v < VECTORS; v++)
            masked[v] = v_reinterpret_as_s32(vx_load_expand_q(allowed + v * WIDTH)) == vx_setzero_s32();
        return lanes & ~negativeLanes(masked);
    }

    const unsigned* codes(int block) const { return pairs.trains + block * layout.blockWords(); }
    const unsigned* plainQuery(int query) const { return pairs.queries + (size_t)query * layout.words(); }

    const CodePairs& pairs;
    const CodeLayout& layout;
    TileQueries queries;
    Collector collector;
    const int blocks, lastLanes;
};

}  // namespace
CV_CPU_OPTIMIZATION_NAMESPACE_END
}  // namespace iib
}  // namespace cv

#endif
