// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// Comparison of codes packed as PACKING_ADDERS, for instruction sets that count the bits of a word fast, or that have
// no tables in registers.

#pragma once

#include "count_vectors.simd.hpp"

namespace cv {
namespace iib {
CV_CPU_OPTIMIZATION_NAMESPACE_BEGIN
namespace {

const CodePacking PACKING = PACKING_ADDERS;

// Queries compared at once with a CodeBlock: as many as the registers hold.
const int QUERIES = WIDTH >= 16 ? 4 : WIDTH >= 8 ? 2 : 1, LISTED_QUERIES = QUERIES;

// Bit counts of words, in a form that is cheap to compute; up to MOST may be added before total().
const int MOST = 31;
#if IIB_COUNTS_LANES
typedef v_uint32 Partial;
inline Partial noBits() { return vx_setzero_u32(); }
inline Partial bitCounts(const Words& x) { return v_popcount(x); }
inline Counts total(const Partial& x) { return v_reinterpret_as_s32(x); }
#else
typedef v_uint8 Partial;
inline Partial noBits() { return vx_setzero_u8(); }
inline Partial bitCounts(const Words& x) { return v_popcount(v_reinterpret_as_u8(x)); }
inline Counts total(const Partial& x) { return v_reinterpret_as_s32(v_dotprod_expand(x, vx_setall_u8(1))); }
#endif

//! The queries that are compared at once.
class TileQueries
{
public:
    explicit TileQueries(const CodeLayout& l) : layout(l), codes(QUERIES * l.words()) {}

    //! @param plain words of the first Q queries.
    template <int Q> void set(const unsigned* plain)
    {
        for (int i = 0; i < Q * layout.words(); i += layout.words())
            layout.pack(plain + i, codes.data() + i);
    }
    const unsigned* operator[](int i) const { return codes.data() + i * layout.words(); }

private:
    const CodeLayout& layout;
    AutoBuffer<unsigned> codes;
};

//! Q queries against a CodeBlock, compared up to some word. Its loops run over all vectors in one go, so that
//! compilers unroll them and keep everything in registers.
template <int Q> class Tile
{
public:
    static constexpr int SIZE = Q * VECTORS;

    //! Compares words 0 to `to`.
    CV_ALWAYS_INLINE void start(const TileQueries& queries, const unsigned* block, int to)
    {
        for (int i = 0; i < SIZE; i++)
            parity[i] = vx_load(block + i % VECTORS * WIDTH) ^ vx_setall_u32(queries[i / VECTORS][0]);
        const int first = std::min(to, 1 + 2 * MOST);
        Partial partial[SIZE];
        addSteps(partial, queries, block, 1, first);
        for (int i = 0; i < SIZE; i++)
            carries[i] = total(partial[i]);
        advance(queries, block, first, to);
    }

    //! Compares words `from` to `to`.
    CV_ALWAYS_INLINE void advance(const TileQueries& queries, const unsigned* block, int from, int to)
    {
        while (from < to)
        {
            const int next = std::min(from + 2 * MOST, to);
            Partial partial[SIZE];
            addSteps(partial, queries, block, from, next);
            for (int i = 0; i < SIZE; i++)
                carries[i] += total(partial[i]);
            from = next;
        }
    }

    CV_ALWAYS_INLINE void distances(Counts* result) const
    {
        for (int i = 0; i < SIZE; i++)
            result[i] = carries[i] + carries[i] + total(bitCounts(parity[i]));
    }

private:
    CV_ALWAYS_INLINE void addSteps(
            Partial* partial, const TileQueries& queries, const unsigned* block, int from, int to)
    {
        Words chain[SIZE];  // a copy, which compilers keep in registers
        Partial sum[SIZE];
        const unsigned* query[Q];
        for (int q = 0; q < Q; q++)
            query[q] = queries[q];
        for (int i = 0; i < SIZE; i++)
        {
            chain[i] = parity[i];
            sum[i] = noBits();
        }
        for (; from < to; from += 2)
            for (int i = 0; i < SIZE; i++)
            {
                const unsigned* q = query[i / VECTORS] + from;
                const unsigned* t = block + i % VECTORS * WIDTH + from * CODES_PER_BLOCK;
                const Words x = vx_load(t) ^ vx_setall_u32(q[0]);
                sum[i] +=
                        bitCounts(fullAdder(chain[i], x, vx_load(t + CODES_PER_BLOCK), vx_setall_u32(q[1])));
            }
        for (int i = 0; i < SIZE; i++)
        {
            parity[i] = chain[i];
            partial[i] = sum[i];
        }
    }

    Words parity[SIZE];
    Counts carries[SIZE];
};

}  // namespace
CV_CPU_OPTIMIZATION_NAMESPACE_END
}  // namespace iib
}  // namespace cv
