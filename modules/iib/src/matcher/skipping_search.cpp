// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "../precomp.hpp"
#include "skipping_search.hpp"
#include "blocked_search.hpp"
#include "pair_blocks.hpp"

namespace cv {
namespace iib {

namespace {

// Fewer queries, or fewer chunks, are not worth a look at how much can be left out.
const int LEAST_QUERIES = 256, LEAST_CHUNKS = 32;
// A chunk that is searched for a single query costs so much more a pair.
const double SINGLE_QUERY = 2;

class SkippingSearch
{
public:
    SkippingSearch(const std::vector<SearchInput>& segments_, KnnTable& found_)
        : segments(segments_), found(found_), chunks(0)
    {
        for (size_t i = 0; i < segments.size(); i++)
        {
            firstChunks.push_back(chunks);
            chunks += (segments[i].trains.blocks() + segments[i].blocks.codeBlocks - 1) /
                      segments[i].blocks.codeBlocks;
        }
    }

    void run()
    {
        const int queries = (int)found.rows(), trial = std::max(queries / 512, 1) * 4;
        if (queries < LEAST_QUERIES || chunks < LEAST_CHUNKS || !fits())
            return all(0, queries);
        all(0, trial);
        const int words = bestWords(trial);
        if (words == 0)
            return all(trial, queries);
        const int parts = 4 * getNumThreads();
        parallel_for_(
                Range(0, parts),
                [&](const Range& range) {
                    const int64 count = queries - trial;
                    skipping(trial + (int)(count * range.start / parts),
                            trial + (int)(count * range.end / parts), words);
                },
                parts);
    }

private:
    const CodeLayout& layout() const { return segments[0].trains.layout(); }

    bool fits() const
    {
        const SearchInput& input = segments[0];
        const CodePairs most(layout(), Mat(input.blocks.queries, 1, CV_8U), 0,
                input.blocks.codeBlocks * CodeLayout::CODES_PER_BLOCK);
        return NearestScan::fits(most) && 8 * layout().bytes() <= USHRT_MAX;
    }

    //! All chunks of some queries.
    void all(int from, int to)
    {
        for (size_t i = 0; i < segments.size(); i++)
            searchNearest(segments[i], Range(from, to), found);
    }

    //! The least distance by the first words, in each chunk for each query: bounds[(query - from) * chunks + chunk].
    std::vector<ushort> boundsOf(int from, int to, int words) const
    {
        std::vector<ushort> bounds((size_t)(to - from) * chunks);
        std::vector<int> distances, indices;
        for (size_t i = 0; i < segments.size(); i++)
        {
            SearchInput shown = segments[i];
            shown.hidden = 0;  // the bounds hold for some of the codes too
            forEachBlock(shown, from, to, [&](const PairBlock& block) {
                distances.assign(block.pairs.queries.rows, INT_MAX);
                indices.assign(distances.size(), -1);
                NearestScan scan(block.pairs, NearestCodes(distances.data(), indices.data()));
                scan.words = words;
                shown.trains.kernels().nearest(scan);
                const size_t chunk = firstChunks[i] +
                                     block.firstTrain / CodeLayout::CODES_PER_BLOCK / shown.blocks.codeBlocks;
                for (size_t q = 0; q < distances.size(); q++)
                    bounds[(block.firstQuery - from + q) * chunks + chunk] = (ushort)distances[q];
            });
        }
        return bounds;
    }

    //! How many words are to be looked at first, judged by queries whose nearest are found; 0: searching all is faster.
    int bestWords(int queries) const
    {
        int best = 0;
        double least = .8;  // of the time of a search of all
        for (int eighths : {1, 2, 3})
        {
            const int words = layout().words() * eighths / 8 | 1;
            const std::vector<ushort> bounds = boundsOf(0, queries, words);
            size_t searched = 0;
            for (size_t i = 0; i < bounds.size(); i++)
                searched += bounds[i] <= found.thresholds()[i / chunks];
            const double time = (double)words / layout().words() + SINGLE_QUERY * searched / bounds.size();
            if (time < least)
            {
                least = time;
                best = words;
            }
        }
        return best;
    }

    void skipping(int from, int to, int words)
    {
        // At most 32 MB of bounds at a time.
        const int step = (int)std::max(((size_t)1 << 24) / chunks, (size_t)64);
        for (int first = from; first < to; first += step)
        {
            const int end = std::min(first + step, to);
            const std::vector<ushort> bounds = boundsOf(first, end, words);
            const auto boundOf = [&](int query) { return &bounds[(size_t)(query - first) * chunks]; };
            std::vector<size_t> nearest;
            for (int query = first; query < end; query++)
            {
                nearest.push_back(std::min_element(boundOf(query), boundOf(query) + chunks) - boundOf(query));
                search(query, nearest.back(), words);
            }
            // The queries that need a chunk one after the other, while it is in the cache.
            for (size_t chunk = 0; chunk < chunks; chunk++)
                for (int query = first; query < end; query++)
                    if (boundOf(query)[chunk] <= found.thresholds()[query] && chunk != nearest[query - first])
                        search(query, chunk, words);
        }
    }

    //! Adds the nearest of one query in one chunk; most codes are too far away after some words.
    void search(int query, size_t chunk, int words)
    {
        const size_t i =
                std::upper_bound(firstChunks.begin(), firstChunks.end(), chunk) - firstChunks.begin() - 1;
        const SearchInput& segment = segments[i];
        const Mat single = segment.queries.row(query);
        SearchInput input(segment.trains, single, segment.policy, segment.masks, segment.blocks);
        input.hidden = segment.hidden;
        input.firstIndex = segment.firstIndex;
        input.firstBlock = (int)(chunk - firstChunks[i]) * segment.blocks.codeBlocks;
        input.endBlock = std::min(input.firstBlock + segment.blocks.codeBlocks, segment.trains.blocks());
        input.early = words;
        // A table of its own, since chunks do not come in the order of their indices: a code as far as the k-th nearest
        // belongs before it if its index is lower.
        KnnTable own(1, found.size());
        if (found.thresholds()[query] < INT_MAX)
            own.thresholds()[0] = found.thresholds()[query] + 1;
        searchNearest(input, Range(0, 1), own);
        for (int n = 0; n < own.size(); n++)
            found.insert(query, own[0][n]);
    }

    const std::vector<SearchInput>& segments;
    KnnTable& found;
    std::vector<size_t> firstChunks;  // of each segment
    size_t chunks;
};

}  // namespace

void searchSkipping(const std::vector<SearchInput>& segments, KnnTable& found)
{
    if (!segments.empty())
        SkippingSearch(segments, found).run();
}

}  // namespace iib
}  // namespace cv
