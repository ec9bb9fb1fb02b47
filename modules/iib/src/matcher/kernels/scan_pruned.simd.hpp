// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#ifndef OPENCV_IIB_MATCHER_KERNELS_SCAN_PRUNED_SIMD_HPP
#define OPENCV_IIB_MATCHER_KERNELS_SCAN_PRUNED_SIMD_HPP

#include "pair_rows.simd.hpp"
#include "scan_full.simd.hpp"
#include "shortlists.simd.hpp"

namespace cv {
namespace iib {
CV_CPU_OPTIMIZATION_NAMESPACE_BEGIN
namespace {

//! Gives pairs up at the stages of a scan.
class PrunedScanner : public SinkScanner
{
public:
    explicit PrunedScanner(const PrunedScan& s)
        : SinkScanner(s.pairs, s.sink), scan(s), policy(s.policy), stageCount((int)policy.stages.size()),
          lists(blocks), queryRow(layout, segmentAt(0) + 1, 1),
          trainRows(layout, segmentAt(0) + 1, s.pairs.paddedTrains()), words(stageCount + 1)
    {
        for (int stage = 0; stage <= stageCount; stage++)
            words[stage] = layout.end(segmentAt(stage));
        early = s.limits && words[0] > 8 ? words[0] * 3 / 4 | 1 : words[0];
    }

    //! Some queries against all blocks: all pairs together up to a stage; then those that pass one by one, or all
    //! to the next stage if they are many.
    template <int Q> void row(int query)
    {
        setQueries<Q>(query);
        // Two stages in one go if the second comes soon after the first, where hardly any tile would end.
        int stage = stageCount > 1 && words[1] - words[0] <= 4 ? 1 : 0;
        if (stage == 0)
            compareToFirst<Q>(query);
        else
            compareToSecond<Q>(query);
        for (; stage < stageCount; compareTo<Q>(query, ++stage))
        {
            int counts[Q], limits[Q], pairCount = 0;
            for (int q = 0; q < Q; q++)
                limits[q] = lowerLimit(query + q, q, stage);
            lists.select<Q>(limits, counts);
            for (int q = 0; q < Q; q++)
                pairCount += counts[q];
            scan.passed[stage] += pairCount;
            if (pairCount * 8 > blocks * words[stage + 1] * Q)
                continue;
            for (int q = 0; q < Q; q++)
                finish(query + q, q, counts[q], stage);
            return;
        }
        for (int q = 0; q < Q; q++)
            for (int block = 0; block < blocks; block++)
            {
                Counts distance[VECTORS], slacks[VECTORS];
                for (int v = 0; v < VECTORS; v++)
                {
                    distance[v] = lists.load(q, block, v);
                    slacks[v] = slack(query + q, block, v, distance[v]);
                }
                collect(query + q, block, distance, slacks);
            }
    }

private:
    //! Writes the distances up to the first stage. With limits, leaves a tile before it once no pair in it can pass.
    template <int Q> void compareToFirst(int query)
    {
        Counts minima[Q], limits[Q];
        for (int q = 0; q < Q; q++)
        {
            minima[q] = vx_setall_s32(NEVER);
            limits[q] = vx_setall_s32(scan.limits ? scan.limits[query + q] : NEVER);
        }
        lists.clear();
        for (int block = 0, ended = 0; block < blocks; block++)
        {
            Tile<Q> tile;
            Counts distance[Tile<Q>::SIZE];
            const int end = block <= 8 + 6 * ended ? early : words[0];
            tile.start(queries, codes(block), end);
            tile.distances(distance);
            if (end < words[0])
            {
                if (!anyWithin<Q>(distance, limits))
                {
                    ended++;
                    continue;
                }
                tile.advance(queries, codes(block), end, words[0]);
                tile.distances(distance);
            }
            for (int i = 0; i < Tile<Q>::SIZE; i++)
            {
                const int q = i / VECTORS, v = i % VECTORS;
                if (incomplete(block))
                    distance[i] = v_select(missing(query + q, block, v) < vx_setzero_s32(),
                            vx_setall_s32(NEVER), distance[i]);
                lists.store(q, block, v, distance[i]);
                minima[q] = v_min(minima[q], distance[i]);
            }
            lists.append(block);
            if (early < words[0] && block % 8 == 0 && policy.margin >= 0)
                for (int q = 0; q < Q; q++)
                    limits[q] = v_min(limits[q], vx_setall_s32(plusMargin(v_reduce_min(minima[q]))));
        }
        for (int q = 0; q < Q; q++)
            least[q] = v_reduce_min(minima[q]);
    }

    //! Writes the distances up to the second stage, and counts the pairs that pass the first.
    template <int Q> void compareToSecond(int query)
    {
        Counts gone = vx_setzero_s32();
        lists.clear();
        for (int block = 0; block < blocks; block++)
        {
            Tile<Q> tile;
            Counts distance[Tile<Q>::SIZE], before[Tile<Q>::SIZE], slack[Tile<Q>::SIZE];
            startStages<Q>(tile, query, block, distance, before, slack);
            endPairs<Q>(0, 0, distance, before, slack);
            for (int i = 0; i < Tile<Q>::SIZE; i++)
                gone += slack[i] >> 31;
            tile.advance(queries, codes(block), words[0], words[1]);
            tile.distances(distance);
            endPairs<Q>(1, 0, distance, before, slack);
            storeRemaining<Q>(block, distance, slack);
        }
        scan.passed[0] += Q * blocks * CODES_PER_BLOCK + v_reduce_sum(gone);
    }

    //! Writes the distances up to any stage, or to the end.
    template <int Q> void compareTo(int query, int stage)
    {
        lists.clear();
        for (int block = 0; block < blocks; block++)
        {
            Tile<Q> tile;
            Counts distance[Tile<Q>::SIZE], before[Tile<Q>::SIZE], slack[Tile<Q>::SIZE];
            startStages<Q>(tile, query, block, distance, before, slack);
            for (int i = 0; i < stage; i++)
            {
                endPairs<Q>(i, scan.limits ? scan.limits + query : 0, distance, before, slack);
                tile.advance(queries, codes(block), words[i], words[i + 1]);
                tile.distances(distance);
            }
            if (stage < stageCount)
                endPairs<Q>(stage, 0, distance, before, slack);
            storeRemaining<Q>(block, distance, slack);
        }
    }

    template <int Q>
    CV_ALWAYS_INLINE void startStages(
            Tile<Q>& tile, int query, int block, Counts* distance, Counts* before, Counts* slack)
    {
        for (int i = 0; i < Tile<Q>::SIZE; i++)
        {
            before[i] = vx_setzero_s32();
            slack[i] = missing(query + i / VECTORS, block, i % VECTORS);
        }
        tile.start(queries, codes(block), words[0]);
        tile.distances(distance);
    }

    //! Makes the slack of the pairs negative that are not to go on at a stage.
    template <int Q>
    CV_ALWAYS_INLINE void endPairs(
            int stage, const int* limits, const Counts* distance, Counts* before, Counts* slack) const
    {
        const Counts most = vx_setall_s32(policy.stages[stage].most);
        for (int i = 0; i < Tile<Q>::SIZE; i++)
        {
            slack[i] = slack[i] | (before[i] + most - distance[i]);
            if (limits)
                slack[i] = slack[i] | (vx_setall_s32(limits[i / VECTORS]) - distance[i]);
            before[i] = distance[i];
        }
    }

    //! NEVER in place of the distances of pairs that ended on the way.
    template <int Q>
    CV_ALWAYS_INLINE void storeRemaining(int block, const Counts* distance, const Counts* slack)
    {
        for (int i = 0; i < Tile<Q>::SIZE; i++)
            lists.store(i / VECTORS, block, i % VECTORS,
                    v_select(slack[i] < vx_setzero_s32(), vx_setall_s32(NEVER), distance[i]));
        lists.append(block);
    }

    template <int Q> static CV_ALWAYS_INLINE bool anyWithin(const Counts* distance, const Counts* limits)
    {
        Counts beyond = vx_setall_s32(-1);
        for (int i = 0; i < Tile<Q>::SIZE; i++)
            beyond = beyond & (limits[i / VECTORS] - distance[i]);
        return !v_check_all(beyond);
    }

    //! The most that may differ at the stage.
    int lowerLimit(int query, int q, int stage)
    {
        // Beyond the first stage, compareToSecond() and compareTo() have looked at it.
        const int most = stage == 0 ? policy.stages[0].most : NEVER - 1;
        if (!scan.limits)
            return most;
        int& limit = scan.limits[query];
        if (policy.margin >= 0)
            limit = std::min(limit, plusMargin(least[q]));
        return std::min(limit, most);
    }
    int plusMargin(int distance) const { return std::min(distance, NEVER - policy.margin) + policy.margin; }

    //! Takes the pairs of a list one by one through the stages that follow.
    void finish(int query, int q, int count, int stage)
    {
        if (count > 0)
            queryRow.set(0, plainQuery(q));
        for (; stage < stageCount && count > 0; stage++)
        {
            if (stage + 1 < stageCount)
                scan.passed[stage + 1] += count = advance(q, count, stage);
            else
                advance(q, count, stage);
        }
        const int *list = lists.list(q), *distance = lists.distances(q),
                  *queryThreshold = sink.queryThresholds + query;
        const int* trainThresholds = sink.trainThresholds;
        for (int i = 0; i < count; i++)
            if (distance[list[i]] < *queryThreshold ||
                    (trainThresholds && distance[list[i]] < trainThresholds[list[i]]))
                sink.found(query, list[i], distance[list[i]]);
    }

    //! Compares the pairs of a list to the stage after a stage; returns how many are left.
    int advance(int q, int count, int stage)
    {
        const int from = segmentAt(stage), to = segmentAt(stage + 1);
        const int most = stage + 1 < stageCount ? policy.stages[stage + 1].most : NEVER;
        const int size = queryRow.count(from, to);
        const unsigned* query = queryRow.after(from, 0);
        int *list = lists.list(q), *distance = lists.distances(q), left = 0;
        for (int i = 0; i < count; i++)
        {
            const int train = list[i];
            trainRows.require(train, pairs.trains);
            const int more = countDifferences(query, trainRows.after(from, train), size);
            distance[train] += more;
            list[left] = train;
            left += more <= most;
        }
        return left;
    }

    //! The segment that ends at a stage, or the last one after the last stage.
    int segmentAt(int stage) const
    {
        return stage < stageCount ? policy.stages[stage].segment : layout.segments() - 1;
    }

    const PrunedScan& scan;
    const PruningPolicy& policy;
    const int stageCount;
    Shortlists lists;
    PairRows queryRow, trainRows;
    AutoBuffer<int> words;  // up to each stage, and in all
    int early;              // words after which a tile is left if no pair in it can pass the first stage
    int least[QUERIES];     // of the distances at the first stage
};

}  // namespace
CV_CPU_OPTIMIZATION_NAMESPACE_END
}  // namespace iib
}  // namespace cv

#endif
