// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "search.hpp"

namespace cv { namespace iib {

namespace {

/** Iterates over chunks of pairs: for some queries all train codes in ascending order, then the next queries. Indices in
`pairs` count from firstQuery and firstTrain. */
class PairChunks
{
public:
    PairChunks(const SearchInput& input_, const Range& range_)
        : pairs{input_.trains.layout(), Mat(), 0, 0, 0}, firstQuery(range_.start), firstTrain(0),
          pairCount(0), input(input_), range(range_),
          step(input.policy.margin >= 0 ? input.chunk.codeBlocksOfLimits : input.chunk.codeBlocks),
          nextBlock(0), limits(range.size(), input.policy.limit)
    {
    }

    //! Goes to the first chunk or to the next; false after the last.
    bool next()
    {
        if (nextBlock >= input.trains.blocks())
        {
            firstQuery += input.chunk.queryCount;
            nextBlock = 0;
        }
        if (firstQuery >= range.end || input.trains.blocks() == 0)
            return false;
        const int count = std::min(step, input.trains.blocks() - nextBlock);
        firstTrain = (size_t)nextBlock * CodeLayout::CODES_PER_BLOCK;
        pairs.queries =
                input.queries.rowRange(firstQuery, std::min(firstQuery + input.chunk.queryCount, range.end));
        pairs.trains = input.trains.block(nextBlock);
        pairs.trainCount =
                (int)std::min(input.trains.rows() - firstTrain, (size_t)count * CodeLayout::CODES_PER_BLOCK);
        nextBlock += count;
        pairs.allowed = 0;
        pairCount = (size_t)pairs.queries.rows * pairs.trainCount;
        if (needsFlags())
            fillFlags();
        return true;
    }

    //! Index of the chunk's first train code in results.
    size_t firstIndex() const { return input.firstIndex + firstTrain; }
    //! The policy's limit for each query of the chunk.
    int* limitsOfQueries() { return &limits[firstQuery - range.start]; }

    CodePairs pairs;
    int firstQuery;
    size_t firstTrain;
    size_t pairCount;  //!< without masked pairs

private:
    //! Whether some pairs of the chunk may be left out.
    bool needsFlags() const
    {
        if (!input.masks.empty() || input.hidden.empty())
            return !input.masks.empty();
        const auto first = input.hidden.begin() + input.trains.imageOf(firstTrain),
                   end = input.hidden.begin() + input.trains.imageOf(firstTrain + pairs.trainCount - 1) + 1;
        return std::find(first, end, true) != end;
    }

    //! Copies the chunk's masks into rows of whole CodeBlocks, and counts the pairs left.
    void fillFlags()
    {
        const PackedCodes& trains = input.trains;
        const size_t width = pairs.paddedTrains(), end = firstTrain + pairs.trainCount;
        flags.assign(pairs.queries.rows * width, 0);
        pairs.allowed = flags.data();
        pairCount = 0;
        for (size_t row = firstTrain; row < end;)
        {
            const size_t image = trains.imageOf(row), count = std::min(trains.start(image + 1), end) - row;
            const bool shown = input.hidden.empty() || !input.hidden[image];
            for (int query = 0; shown && query < pairs.queries.rows; query++)
            {
                uchar* to = flags.data() + query * width + (row - firstTrain);
                if (input.masks.empty() || input.masks[image].empty())
                    std::fill(to, to + count, (uchar)1);
                else
                    std::copy_n(input.masks[image].ptr(firstQuery + query) + (row - trains.start(image)),
                            count, to);
                pairCount += count - std::count(to, to + count, (uchar)0);
            }
            row += count;
        }
    }

    const SearchInput& input;
    const Range range;
    const int step;
    int nextBlock;
    std::vector<int> limits;
    std::vector<uchar> flags;
};

//! Calls report(query, train, distance) for the pairs of a chunk that are below a threshold.
void scanPruned(const SearchInput& input, PairChunks& chunk, const int* queryThresholds,
        const int* trainThresholds, const PairReport& report)
{
    const std::vector<PruneStage>& stages = input.policy.stages;
    const CodeLayout& layout = input.trains.layout();
    std::vector<int64> passed(stages.size(), 0);
    const PrunedScan scan = {chunk.pairs, input.policy, queryThresholds, trainThresholds, report,
            passed.data(), stages.size() == 1 ? chunk.limitsOfQueries() : 0};
    input.trains.kernels().pruned(scan);

    input.cost.all += (uint64)chunk.pairCount * 8 * layout.bytes();
    uint64 alive = chunk.pairCount;
    int bits = 0;
    for (size_t i = 0; i < stages.size(); i++)
    {
        input.cost.compared += alive * (layout.bits(stages[i].words) - bits);
        bits = layout.bits(stages[i].words);
        alive = passed[i];
    }
    input.cost.compared += alive * (8 * layout.bytes() - bits);
}

// For queries with one or two neighbours, train codes with one, and no stages.
void scanFew(const SearchInput& input, const PairChunks& chunk, KnnTable& forQueries, KnnTable* forTrains)
{
    const NearestScan scan = {chunk.pairs, forQueries[chunk.firstQuery], forQueries.size(),
            forTrains ? (*forTrains)[chunk.firstTrain] : 0, (size_t)chunk.firstQuery, chunk.firstIndex()};
    input.trains.kernels().nearest(scan);
    const uint64 bits = (uint64)chunk.pairCount * 8 * input.trains.layout().bytes();
    input.cost.compared += bits;
    input.cost.all += bits;
}

}  // namespace

void scanNearest(const SearchInput& input, const Range& queries, KnnTable& forQueries, KnnTable* forTrains)
{
    const bool few =
            forQueries.size() <= 2 && (!forTrains || forTrains->size() == 1) && input.policy.stages.empty();
    for (PairChunks chunk(input, queries); chunk.next();)
        if (few && NearestScan::fits(chunk.pairs))
            scanFew(input, chunk, forQueries, forTrains);
        else
            scanPruned(input, chunk, forQueries.thresholds() + chunk.firstQuery,
                    forTrains ? forTrains->thresholds() + chunk.firstTrain : 0,
                    [&](int query, int train, int distance) {
                        forQueries.insert(
                                chunk.firstQuery + query, matchKey(distance, chunk.firstIndex() + train));
                        if (forTrains)
                            forTrains->insert(
                                    chunk.firstTrain + train, matchKey(distance, chunk.firstQuery + query));
                    });
}

void scanWithin(
        const SearchInput& input, const Range& queries, int radius, std::vector<std::vector<MatchKey>>& lists)
{
    const std::vector<int> thresholds(std::min(queries.size(), input.chunk.queryCount), radius + 1);
    for (PairChunks chunk(input, queries); chunk.next();)
        scanPruned(input, chunk, thresholds.data(), 0, [&](int query, int train, int distance) {
            lists[chunk.firstQuery + query].push_back(matchKey(distance, chunk.firstIndex() + train));
        });
}

}}  // namespace cv::iib
