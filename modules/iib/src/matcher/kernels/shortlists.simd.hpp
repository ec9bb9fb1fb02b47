// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// What a pruned scan keeps of some queries and all train codes.

#pragma once

#include "../../common/aligned_buffer.hpp"
#include "scanner.simd.hpp"

namespace cv {
namespace iib {
CV_CPU_OPTIMIZATION_NAMESPACE_BEGIN
namespace {

const int NEVER = INT_MAX;  // the distance of pairs that ended

//! Writes the values of some lanes, and may write CODES_PER_BLOCK values whatever their number.
CV_ALWAYS_INLINE void storeLanes(int* to, const Counts* values, int lanes)
{
#if CV_AVX512_SKX && IIB_NATIVE_VECTORS
    v_store(to, v_int32(_mm512_maskz_compress_epi32((__mmask16)lanes, values[0].val)));
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
          values(QUERIES * rowSize), lists(QUERIES * listSize)
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
            for (int q = 0; q < Q; q++)  // several at a time, whose steps overlap
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
    //! storeLanes() writes beyond the end: there is room for a CodeBlock more.
    int* list(int q) { return lists.data() + q * listSize; }

private:
    const int blocks;
    const size_t rowSize, listSize;
    AlignedBuffer<int> values, lists;
};

//! The plain words of train codes, each unpacked when it is asked for.
class PlainCodes
{
public:
    //! @param count how many there may be to unpack: all or none.
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

}  // namespace
CV_CPU_OPTIMIZATION_NAMESPACE_END
}  // namespace iib
}  // namespace cv
