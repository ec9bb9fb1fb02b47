// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "../precomp.hpp"
#include "blocked_search.hpp"
#include "pair_blocks.hpp"

#include <mutex>

namespace cv {
namespace iib {

namespace {

//! Puts the pairs of a block into tables of any k.
class TableSink CV_FINAL : public HammingSink
{
public:
    TableSink(const PairBlock& block, KnnTable& forQueries_, KnnTable* forTrains_)
        : HammingSink(forQueries_.thresholds() + block.firstQuery,
                  forTrains_ ? forTrains_->thresholds() + block.firstTrain : 0),
          forQueries(forQueries_), forTrains(forTrains_), firstQuery(block.firstQuery),
          firstTrain(block.firstTrain), firstIndex(block.firstIndex)
    {
    }
    void found(int query, int train, int distance) CV_OVERRIDE
    {
        forQueries.insert(firstQuery + query, matchKey(distance, firstIndex + train));
        if (forTrains)
            forTrains->insert(firstTrain + train, matchKey(distance, firstQuery + query));
    }

private:
    KnnTable& forQueries;
    KnnTable* forTrains;
    const size_t firstQuery, firstTrain, firstIndex;
};

//! Lists all pairs of a block that are below one threshold.
class ListSink CV_FINAL : public HammingSink
{
public:
    ListSink(const PairBlock& block, const int* thresholds, std::vector<std::vector<MatchKey>>& result_)
        : HammingSink(thresholds, 0), result(result_), firstQuery(block.firstQuery),
          firstIndex(block.firstIndex)
    {
    }
    void found(int query, int train, int distance) CV_OVERRIDE
    {
        result[firstQuery + query].push_back(matchKey(distance, firstIndex + train));
    }

private:
    std::vector<std::vector<MatchKey>>& result;
    const size_t firstQuery, firstIndex;
};

//! The queries that one thread takes, and the limits of the policy for each.
class PartialSearch
{
public:
    PartialSearch(const SearchInput& input_, int from_, int to_)
        : input(input_), from(from_), to(to_), limits(to_ - from_, input_.policy.limit)
    {
    }

    SearchCost nearest(KnnTable& forQueries, KnnTable* forTrains)
    {
        const bool single = forQueries.size() == 1 && (!forTrains || forTrains->size() == 1);
        return visit([&](const PairBlock& block) {
            if (single && input.policy.stages.empty() && NearestScan::fits(block.pairs))
                return nearestOfOne(block, forQueries, forTrains);
            TableSink sink(block, forQueries, forTrains);
            return pruned(block, sink);
        });
    }

    SearchCost within(int radius, std::vector<std::vector<MatchKey>>& result)
    {
        const std::vector<int> thresholds(std::min(to - from, input.blocks.queries), radius + 1);
        return visit([&](const PairBlock& block) {
            ListSink sink(block, thresholds.data(), result);
            return pruned(block, sink);
        });
    }

private:
    SearchCost visit(const std::function<SearchCost(const PairBlock&)>& scan)
    {
        SearchCost cost;
        forEachBlock(input, from, to, [&](const PairBlock& block) { cost += scan(block); });
        return cost;
    }

    SearchCost nearestOfOne(const PairBlock& block, KnnTable& forQueries, KnnTable* forTrains)
    {
        const int queries = block.pairs.queries.rows, trains = block.pairs.trainCount;
        queryIndices.assign(queries, -1);
        NearestScan scan(
                block.pairs, NearestCodes(forQueries.thresholds() + block.firstQuery, queryIndices.data()));
        if (forTrains)
        {
            trainIndices.assign(trains, -1);
            scan.ofTrains = NearestCodes(forTrains->thresholds() + block.firstTrain, trainIndices.data());
        }
        input.trains.kernels().nearest(scan);
        for (int i = 0; i < queries; i++)
            if (queryIndices[i] >= 0)
                forQueries.insert(block.firstQuery + i,
                        matchKey(scan.ofQueries.distances[i], block.firstIndex + queryIndices[i]));
        for (int i = 0; forTrains && i < trains; i++)
            if (trainIndices[i] >= 0)
                forTrains->insert(block.firstTrain + i,
                        matchKey(scan.ofTrains.distances[i], (size_t)block.firstQuery + trainIndices[i]));
        SearchCost cost;
        cost.compared = cost.all = (uint64)block.pairCount * 8 * input.trains.layout().bytes();
        return cost;
    }

    SearchCost pruned(const PairBlock& block, HammingSink& sink)
    {
        const PruningPolicy& policy = input.policy;
        const CodeLayout& layout = input.trains.layout();
        std::vector<int64> passed(policy.stages.size(), 0);
        PrunedScan scan(block.pairs, sink);
        scan.stages = policy.stages.data();
        scan.stageCount = (int)policy.stages.size();
        scan.passed = passed.data();
        scan.limits = policy.stages.size() == 1 ? &limits[block.firstQuery - from] : 0;
        scan.margin = policy.margin;
        input.trains.kernels().pruned(scan);

        SearchCost cost;
        cost.all = (uint64)block.pairCount * 8 * layout.bytes();
        uint64 alive = block.pairCount;
        for (int segment = 0, stage = 0; segment < layout.segments(); segment++)
        {
            cost.compared += alive * layout.bits(segment);
            if (stage < scan.stageCount && policy.stages[stage].segment == segment)
                alive = passed[stage++];
        }
        return cost;
    }

    const SearchInput& input;
    const int from, to;
    std::vector<int> limits, queryIndices, trainIndices;
};

// Cuts the queries in parts for threads.
SearchCost split(int queries, int parts, const std::function<SearchCost(int, int)>& body)
{
    const int size = std::max((queries + parts - 1) / parts, 4);  // a tile's queries
    parts = (queries + size - 1) / size;
    SearchCost cost;
    std::mutex lock;
    parallel_for_(
            Range(0, parts),
            [&](const Range& range) {
                const SearchCost work = body(range.start * size, std::min(range.end * size, queries));
                std::lock_guard<std::mutex> guard(lock);
                cost += work;
            },
            parts);
    return cost;
}

// Some parts for each thread, so that all are done at about the same time.
int evenParts(const SearchInput& input, int queries)
{
    const int blocks = (queries + input.blocks.queries - 1) / input.blocks.queries, threads = getNumThreads();
    return std::max((blocks + threads - 1) / threads, 2) * threads;
}

}  // namespace

SearchCost searchNearest(const SearchInput& input, KnnTable& forQueries, KnnTable* forTrains)
{
    if (!forTrains)
        return split(input.queries.rows, evenParts(input, input.queries.rows),
                [&](int from, int to) { return PartialSearch(input, from, to).nearest(forQueries, 0); });
    // In the other direction each part has neighbours of its own, merged by their order, so that the result
    // does not depend on which is done first. Few parts, since each begins without thresholds.
    std::mutex lock;
    return split(input.queries.rows, getNumThreads(), [&](int from, int to) {
        KnnTable own(forTrains->rows(), forTrains->size(), CodeLayout::CODES_PER_BLOCK);
        const SearchCost cost = PartialSearch(input, from, to).nearest(forQueries, &own);
        std::lock_guard<std::mutex> guard(lock);
        forTrains->merge(own);
        return cost;
    });
}

SearchCost searchWithin(const SearchInput& input, int radius, std::vector<std::vector<MatchKey>>& result)
{
    return split(input.queries.rows, evenParts(input, input.queries.rows),
            [&](int from, int to) { return PartialSearch(input, from, to).within(radius, result); });
}

}  // namespace iib
}  // namespace cv
