// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#pragma once

#include "../../common/aligned_buffer.hpp"
#include "scan_nearest.simd.hpp"

namespace cv { namespace iib {
CV_CPU_OPTIMIZATION_NAMESPACE_BEGIN
namespace {

const int NEVER = INT_MAX;  // the distance of dropped pairs

//! Writes the values of some lanes side by side; may write up to CODES_PER_BLOCK values.
CV_ALWAYS_INLINE void storeLanes(int* to, const Counts* values, int lanes)
{
#if IIB_COMPRESSES_LANES
    v_store(to, compressed(values[0], lanes));
#else
    int all[CODES_PER_BLOCK];
    for (int v = 0; v < VECTORS; v++)
        v_store(all + v * WIDTH, values[v]);
    for (; lanes; lanes &= lanes - 1)
        *to++ = all[trailingZeros32(lanes)];
#endif
}

//! Distances, and lists of the train codes that pass a stage.
class Shortlists
{
public:
    explicit Shortlists(int blocks_)
        : blocks(blocks_), rowSize((size_t)blocks * CODES_PER_BLOCK), listSize(rowSize + CODES_PER_BLOCK),
          values(LISTED_QUERIES * rowSize), lists(LISTED_QUERIES * listSize)
    {
    }

    void store(int q, int block, int v, const Counts& distance)
    {
        v_store(distances(q) + block * CODES_PER_BLOCK + v * WIDTH, distance);
    }
    Counts load(int q, int block, int v) const
    {
        return vx_load(values.data() + q * rowSize + block * CODES_PER_BLOCK + v * WIDTH);
    }

    //! Lists the train codes whose distance to each query is at most its limit, and counts them.
    template <int Q> void select(const int* limits, int* counts)
    {
        int* end[Q];
        for (int q = 0; q < Q; q++)
            end[q] = list(q);
        for (int block = 0; block < blocks; block++)
            for (int q = 0; q < Q; q++)  // interleaved, so that the queries' steps overlap
            {
                Counts trains[VECTORS], slack[VECTORS];
                for (int v = 0; v < VECTORS; v++)
                {
                    trains[v] = laneNumbers() + vx_setall_s32(block * CODES_PER_BLOCK + v * WIDTH);
                    slack[v] = vx_setall_s32(limits[q]) - load(q, block, v);
                }
                const int lanes = ALL_LANES & ~negativeLanes(slack);
                storeLanes(end[q], trains, lanes);
                end[q] += countBits((unsigned)lanes);
            }
        for (int q = 0; q < Q; q++)
            counts[q] = (int)(end[q] - list(q));
    }

    int* distances(int q) { return values.data() + q * rowSize; }
    //! With room for a CodeBlock more, since storeLanes() writes beyond the end.
    int* list(int q) { return lists.data() + q * listSize; }

private:
    const int blocks;
    const size_t rowSize, listSize;
    AlignedBuffer<int> values, lists;
};

//! The plain words of train codes, unpacked on first use.
class PlainCodes
{
public:
    //! @param count number of train codes, or 0 if none is needed.
    PlainCodes(const CodePairs& p, int count)
        : pairs(p), known(count), words((size_t)count * p.layout.words())
    {
        std::fill_n(known.data(), count, (uchar)0);
    }

    const unsigned* operator[](int train)
    {
        const CodeLayout& layout = pairs.layout;
        unsigned* const code = words.data() + (size_t)train * layout.words();
        if (!known[train])
            layout.fetch(pairs.trains + train / CODES_PER_BLOCK * layout.blockWords(),
                    train % CODES_PER_BLOCK, code);
        known[train] = 1;
        return code;
    }

private:
    const CodePairs& pairs;
    AutoBuffer<uchar> known;
    AlignedBuffer<unsigned> words;
};

//! Hamming distance of two arrays of words.
inline int countDifferences(const unsigned* a, const unsigned* b, int words)
{
    int count = words % 2 ? countBits(a[words - 1] ^ b[words - 1]) : 0;
    for (int i = 0; i + 1 < words; i += 2)
    {
        uint64 x, y;
        memcpy(&x, a + i, sizeof(x));
        memcpy(&y, b + i, sizeof(y));
        count += countBits(x ^ y);
    }
    return count;
}

//! Drops pairs at the stages of a scan, and reports those below the thresholds.
class PrunedScanner : public Scanner
{
public:
    explicit PrunedScanner(const PrunedScan& s)
        : Scanner(s.pairs), scan(s), policy(s.policy), stageCount((int)policy.stages.size()), lists(blocks),
          trains(s.pairs, stageCount > 0 ? s.pairs.trainCount : 0), words(stageCount + 1)
    {
        for (int stage = 0; stage < stageCount; stage++)
            words[stage] = policy.stages[stage].words;
        words[stageCount] = layout.words();
    }

    //! Compares Q queries with all blocks: all pairs up to a stage; then the pairs that pass one by one, or, if they are
    //! many, all pairs to the next stage.
    template <int Q> void row(int query)
    {
        setQueries<Q>(query);
        // two stages in one pass if the second follows closely
        int stage = stageCount > 1 && words[1] - words[0] <= 4 ? 1 : 0;
        stage == 1 ? compareTo<Q, 1>(query, 1, 0) : compareTo<Q, ANY>(query, 0, -1);
        for (; stage < stageCount; compareTo<Q, ANY>(query, ++stage, -1))
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
                collect(query + q, q, block);
    }

private:
    //! Reports the pairs of a block that are below a threshold.
    void collect(int query, int q, int block)
    {
        Counts distances[VECTORS], slack[VECTORS];
        for (int v = 0; v < VECTORS; v++)
        {
            distances[v] = lists.load(q, block, v);
            Counts threshold = vx_setall_s32(scan.queryThresholds[query]);
            if (const int* ofTrains = scan.trainThresholds)
                threshold = v_max(threshold, vx_load(ofTrains + block * CODES_PER_BLOCK + v * WIDTH));
            slack[v] = distances[v] - threshold;
        }
        int lanes = negativeLanes(slack), near[CODES_PER_BLOCK];
        if (!lanes)
            return;
        storeLanes(near, distances, lanes);
        for (int i = 0; lanes; lanes &= lanes - 1)
            scan.found(query, block * CODES_PER_BLOCK + trailingZeros32(lanes), near[i++]);
    }

    //! Stores the distances up to a stage, or to the end; NEVER for dropped pairs. Counts the pairs that pass stage
    //! `counted`, an earlier one, unless it is negative. STAGE is the stage, or ANY.
    template <int Q, int STAGE> void compareTo(int query, int anyStage, int counted)
    {
        const int stage = STAGE == ANY ? anyStage : STAGE;
        Counts gone = vx_setzero_s32(), minima[Q];
        for (int q = 0; q < Q; q++)
            minima[q] = vx_setall_s32(NEVER);
        for (int block = 0; block < blocks; block++)
        {
            BlockDistances<Q> tile;
            Counts distance[BlockDistances<Q>::SIZE], before[BlockDistances<Q>::SIZE],
                    slack[BlockDistances<Q>::SIZE];
            for (int i = 0; i < BlockDistances<Q>::SIZE; i++)
            {
                before[i] = vx_setzero_s32();
                slack[i] = missing(query + i / VECTORS, block, i % VECTORS);
            }
            tile.start(queries, codes(block), words[0]);
            tile.distances(distance);
            for (int i = 0; i < stage; i++)
            {
                endPairs<Q>(i, scan.limits ? scan.limits + query : 0, distance, before, slack);
                for (int j = 0; j < BlockDistances<Q>::SIZE && i == counted; j++)
                    gone += slack[j] >> 31;
                tile.advance(queries, codes(block), words[i], words[i + 1]);
                tile.distances(distance);
            }
            if (stage > 0 && stage < stageCount)
                endPairs<Q>(stage, 0, distance, before, slack);
            for (int i = 0; i < BlockDistances<Q>::SIZE; i++)
            {
                Counts left = distance[i];
                if (stage > 0 || incomplete(block))
                    left = v_select(slack[i] < vx_setzero_s32(), vx_setall_s32(NEVER), left);
                lists.store(i / VECTORS, block, i % VECTORS, left);
                minima[i / VECTORS] = v_min(minima[i / VECTORS], left);
            }
        }
        if (counted >= 0)
            scan.passed[counted] += Q * blocks * CODES_PER_BLOCK + v_reduce_sum(gone);
        for (int q = 0; q < Q; q++)
            least[q] = v_reduce_min(minima[q]);
    }

    //! Makes the slack of pairs that a stage drops negative.
    template <int Q>
    CV_ALWAYS_INLINE void endPairs(
            int stage, const int* limits, const Counts* distance, Counts* before, Counts* slack) const
    {
        const Counts most = vx_setall_s32(policy.stages[stage].most);
        for (int i = 0; i < BlockDistances<Q>::SIZE; i++)
        {
            slack[i] = slack[i] | (before[i] + most - distance[i]);
            if (limits)
                slack[i] = slack[i] | (vx_setall_s32(limits[i / VECTORS]) - distance[i]);
            before[i] = distance[i];
        }
    }

    //! The largest partial distance that passes the stage. compareTo() has checked all stages but the first.
    int lowerLimit(int query, int q, int stage)
    {
        const int most = stage == 0 ? policy.stages[0].most : NEVER - 1;
        if (!scan.limits)
            return most;
        int& limit = scan.limits[query];
        if (policy.margin >= 0)
            limit = std::min(limit, std::min(least[q], NEVER - policy.margin) + policy.margin);
        return std::min(limit, most);
    }

    //! Compares the pairs of a list one by one through the remaining stages.
    void finish(int query, int q, int count, int stage)
    {
        for (; stage < stageCount && count > 0; stage++)
        {
            count = advance(q, count, stage);
            if (stage + 1 < stageCount)
                scan.passed[stage + 1] += count;
        }
        const int *list = lists.list(q), *distance = lists.distances(q),
                  *queryThreshold = scan.queryThresholds + query, *trainThresholds = scan.trainThresholds;
        for (int i = 0; i < count; i++)
            if (distance[list[i]] < *queryThreshold ||
                    (trainThresholds && distance[list[i]] < trainThresholds[list[i]]))
                scan.found(query, list[i], distance[list[i]]);
    }

    //! Compares the pairs of a list from a stage to the next; returns the number left.
    int advance(int q, int count, int stage)
    {
        const int most = stage + 1 < stageCount ? policy.stages[stage + 1].most : NEVER;
        const int from = words[stage], size = words[stage + 1] - from;
        int *list = lists.list(q), *distance = lists.distances(q), left = 0;
        for (int i = 0; i < count; i++)
        {
            const int train = list[i];
            const int more = countDifferences(plainQuery(q) + from, trains[train] + from, size);
            distance[train] += more;
            list[left] = train;
            left += more <= most;
        }
        return left;
    }

    static constexpr int ANY = -1;

    const PrunedScan& scan;
    const PruningPolicy& policy;
    const int stageCount;
    Shortlists lists;
    PlainCodes trains;
    AutoBuffer<int> words;      //!< up to each stage, then the total
    int least[LISTED_QUERIES];  //!< smallest distance of each query in compareTo()
};

}  // namespace
CV_CPU_OPTIMIZATION_NAMESPACE_END
}}  // namespace cv::iib
