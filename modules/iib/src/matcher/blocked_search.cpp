// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "../precomp.hpp"
#include "blocked_search.hpp"

#include <mutex>

namespace cv {
namespace iib {

static const int CODES_PER_BLOCK = CodeLayout::CODES_PER_BLOCK;
// Both packed blocks together stay in a second-level cache of 512 KB with the default descriptor.
static const int BLOCK_QUERIES = 4096, BLOCK_GROUPS = 128;

namespace {

class NearestSink CV_FINAL : public BlockSink
{
public:
    NearestSink(KnnTable& forQueries_, KnnTable* forTrains_) : forQueries(forQueries_), forTrains(forTrains_)
    {
    }
    const int* queryBelow() const CV_OVERRIDE { return forQueries.below() + firstQuery; }
    const int* trainBelow() const CV_OVERRIDE { return forTrains ? forTrains->below() + firstTrain : 0; }
    void found(int query, int train, int distance) CV_OVERRIDE
    {
        forQueries.insert(firstQuery + query, matchKey(distance, firstTrain + train));
        if (forTrains)
            forTrains->insert(firstTrain + train, matchKey(distance, firstQuery + query));
    }

private:
    KnnTable& forQueries;
    KnnTable* forTrains;
};

class RadiusSink CV_FINAL : public BlockSink
{
public:
    RadiusSink(int radius, std::vector<std::vector<MatchKey>>& result_)
        : result(result_), below(BLOCK_QUERIES, radius + 1)
    {
    }
    const int* queryBelow() const CV_OVERRIDE { return below.data(); }
    const int* trainBelow() const CV_OVERRIDE { return 0; }
    void found(int query, int train, int distance) CV_OVERRIDE
    {
        result[firstQuery + query].push_back(matchKey(distance, firstTrain + train));
    }

private:
    std::vector<std::vector<MatchKey>>& result;
    const std::vector<int> below;
};

}  // namespace

BlockedSearch::BlockedSearch(const PackedCodes& index_, const Mat& codes_, const Mat& queries_,
        const PruningPolicy& plan_, const std::vector<Mat>& masks_)
    : index(index_), codes(codes_), queries(queries_), plan(plan_), masks(masks_)
{
}

SearchCost BlockedSearch::nearest(KnnTable& forQueries, KnnTable* forTrains) const
{
    SearchCost cost;
    std::mutex lock;
    // In the other direction each part has neighbours of its own, merged by their order, so that the result
    // does not depend on who comes first. Few parts, since each starts anew to learn what is near.
    split(
            forTrains ? getNumThreads() : evenParts(),
            [&](int from, int to) {
                if (!forTrains)
                {
                    NearestSink sink(forQueries, 0);
                    return run(from, to, sink);
                }
                KnnTable part(forTrains->rows(), forTrains->size(), CODES_PER_BLOCK);
                NearestSink sink(forQueries, &part);
                const SearchCost work = run(from, to, sink);
                std::lock_guard<std::mutex> guard(lock);
                forTrains->merge(part);
                return work;
            },
            cost);
    return cost;
}

SearchCost BlockedSearch::within(int radius, std::vector<std::vector<MatchKey>>& result) const
{
    SearchCost cost;
    split(
            evenParts(),
            [&](int from, int to) {
                RadiusSink sink(radius, result);
                return run(from, to, sink);
            },
            cost);
    return cost;
}

int BlockedSearch::evenParts() const
{
    const int blocks = (queries.rows + BLOCK_QUERIES - 1) / BLOCK_QUERIES, threads = getNumThreads();
    return std::max((blocks + threads - 1) / threads, 2) * threads;
}

void BlockedSearch::split(int parts, const std::function<SearchCost(int, int)>& body, SearchCost& cost) const
{
    const int size = std::max((queries.rows + parts - 1) / parts, 4);  // a tile's queries
    parts = (queries.rows + size - 1) / size;
    std::mutex lock;
    parallel_for_(
            Range(0, parts),
            [&](const Range& range) {
                const SearchCost work = body(range.start * size, std::min(range.end * size, queries.rows));
                std::lock_guard<std::mutex> guard(lock);
                cost.compared += work.compared;
                cost.all += work.all;
            },
            parts);
}

SearchCost BlockedSearch::run(int from, int to, BlockSink& sink) const
{
    const CodeLayout& layout = index.layout();
    std::vector<unsigned> plain((size_t)std::min(to - from, BLOCK_QUERIES) * layout.words());
    SearchCost cost;
    for (; from < to; from += BLOCK_QUERIES)
    {
        const int end = std::min(from + BLOCK_QUERIES, to);
        for (int i = from; i < end; i++)
            layout.arrange(queries.ptr(i), &plain[(size_t)(i - from) * layout.words()]);
        std::vector<int> limits(end - from, plan.limit);
        for (int group = 0; group < codes.rows; group += BLOCK_GROUPS)
        {
            sink.moveTo(from, (size_t)group * CODES_PER_BLOCK);
            const SearchCost work = block(from, end, group, std::min(BLOCK_GROUPS, codes.rows - group),
                    plain.data(), limits.data(), sink);
            cost.compared += work.compared;
            cost.all += work.all;
        }
    }
    return cost;
}

SearchCost BlockedSearch::block(
        int from, int to, int group, int groups, const unsigned* plain, int* limits, BlockSink& sink) const
{
    const CodeLayout& layout = index.layout();
    const size_t row = (size_t)group * CODES_PER_BLOCK,
                 count = std::min(index.rows() - row, (size_t)groups * CODES_PER_BLOCK);
    std::vector<uchar> allowed;
    size_t pairs = (to - from) * count;
    if (!masks.empty() || count < (size_t)groups * CODES_PER_BLOCK)
    {
        allowed.assign((size_t)(to - from) * groups * CODES_PER_BLOCK, 0);
        pairs = allow(from, to, row, count, allowed.data());
    }
    std::vector<int64> passed(plan.stops.size(), 0);

    HammingScan scan;
    scan.layout = &layout;
    scan.queries = plain;
    scan.queryCount = to - from;
    scan.trains = codes.ptr<unsigned>(group);
    scan.groups = groups;
    scan.allowed = allowed.empty() ? 0 : allowed.data();
    scan.stops = plan.stops.data();
    scan.stopCount = (int)plan.stops.size();
    scan.passed = passed.data();
    scan.limits = plan.stops.size() == 1 ? limits : 0;
    scan.margin = plan.margin;
    scan.queryBelow = sink.queryBelow();
    scan.trainBelow = sink.trainBelow();
    scan.sink = &sink;
    hammingScan(scan);

    SearchCost cost;
    cost.all = (uint64)pairs * 8 * layout.bytes();
    uint64 alive = pairs;
    for (int part = 0, stop = 0; part < layout.parts(); part++)
    {
        cost.compared += alive * layout.bits(part);
        if (stop < scan.stopCount && plan.stops[stop].part == part)
            alive = passed[stop++];
    }
    return cost;
}

size_t BlockedSearch::allow(int from, int to, size_t firstRow, size_t count, uchar* allowed) const
{
    const size_t stride = (count + CODES_PER_BLOCK - 1) / CODES_PER_BLOCK * CODES_PER_BLOCK,
                 end = firstRow + count;
    size_t pairs = 0;
    for (size_t row = firstRow; row < end;)
    {
        const size_t image = index.imageOf(row), next = std::min(index.start(image + 1), end);
        for (int query = from; query < to; query++)
        {
            uchar* flags = allowed + (query - from) * stride + (row - firstRow);
            if (masks.empty() || masks[image].empty())
                std::fill(flags, flags + (next - row), (uchar)1);
            else
            {
                const uchar* mask = masks[image].ptr(query) + (row - index.start(image));
                std::copy(mask, mask + (next - row), flags);
            }
            pairs += (next - row) - std::count(flags, flags + (next - row), (uchar)0);
        }
        row = next;
    }
    return pairs;
}

}  // namespace iib
}  // namespace cv
