// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "../precomp.hpp"
#include "pair_blocks.hpp"

namespace cv {
namespace iib {

// Whether some pairs of a block may be left out.
static bool needsFlags(const SearchInput& input, const PairBlock& block)
{
    if (!input.masks.empty() || !input.hidden)
        return !input.masks.empty();
    const PackedCodes& trains = input.trains;
    const auto first = input.hidden->begin() + trains.imageOf(block.firstTrain),
               end = input.hidden->begin() + trains.imageOf(block.firstTrain + block.pairs.trainCount - 1) +
                     1;
    return std::find(first, end, true) != end;
}

// Copies the masks of a block of pairs into flags, rows of a whole number of CodeBlocks, and counts the pairs left.
static size_t fillFlags(const SearchInput& input, const PairBlock& block, std::vector<uchar>& flags)
{
    const PackedCodes& trains = input.trains;
    const size_t step = block.pairs.paddedTrains(), end = block.firstTrain + block.pairs.trainCount;
    flags.assign(block.pairs.queries.rows * step, 0);
    size_t count = 0;
    for (size_t row = block.firstTrain; row < end;)
    {
        const size_t image = trains.imageOf(row), next = std::min(trains.start(image + 1), end);
        const bool shown = !input.hidden || !(*input.hidden)[image];
        for (int query = 0; shown && query < block.pairs.queries.rows; query++)
        {
            uchar* to = flags.data() + query * step + (row - block.firstTrain);
            if (input.masks.empty() || input.masks[image].empty())
                std::fill(to, to + (next - row), (uchar)1);
            else
            {
                const uchar* mask =
                        input.masks[image].ptr(block.firstQuery + query) + (row - trains.start(image));
                std::copy(mask, mask + (next - row), to);
            }
            count += (next - row) - std::count(to, to + (next - row), (uchar)0);
        }
        row = next;
    }
    return count;
}

void forEachBlock(
        const SearchInput& input, int from, int to, const std::function<void(const PairBlock&)>& visit)
{
    const PackedCodes& trains = input.trains;
    const CodeLayout& layout = trains.layout();
    const size_t rows = trains.rows();
    std::vector<uchar> flags;
    for (int query = from; query < to; query += input.blocks.queries)
    {
        const int queryCount = std::min(input.blocks.queries, to - query);
        const Mat queries = input.queries.rowRange(query, query + queryCount);
        for (int first = 0; first < trains.blocks(); first += input.blocks.codeBlocks)
        {
            const int blocks = std::min(input.blocks.codeBlocks, trains.blocks() - first);
            const size_t train = (size_t)first * CodeLayout::CODES_PER_BLOCK;
            const size_t trainCount = std::min(rows - train, (size_t)blocks * CodeLayout::CODES_PER_BLOCK);
            const unsigned* const codes = trains.block(first);
            PairBlock block = {CodePairs(layout, queries, codes, (int)trainCount), query, train,
                    input.firstIndex + train, queryCount * trainCount};
            if (needsFlags(input, block))
            {
                block.pairCount = fillFlags(input, block, flags);
                block.pairs.allowed = flags.data();
            }
            visit(block);
        }
    }
}

}  // namespace iib
}  // namespace cv
