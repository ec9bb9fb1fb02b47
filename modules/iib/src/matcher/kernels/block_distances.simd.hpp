// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// Hamming distances of some queries to the codes of a CodeBlock: QueryGroup prepares the queries, BlockDistances compares them,
// and PACKING is the packing of codes that both need.

#pragma once

#include "../../common/aligned_buffer.hpp"
#include "../../common/vectors.simd.hpp"

#include "opencv2/iib/detail/packed_codes.hpp"

namespace cv { namespace iib {
CV_CPU_OPTIMIZATION_NAMESPACE_BEGIN
namespace {

typedef v_uint32 Words;
typedef v_int32 Counts;
const int CODES_PER_BLOCK = CodeLayout::CODES_PER_BLOCK, WIDTH = VTraits<Words>::max_nlanes,
          VECTORS = CODES_PER_BLOCK / WIDTH, ALL_LANES = (1 << CODES_PER_BLOCK) - 1;

//! 0, 1, 2, ... over the lanes of a vector.
inline Counts laneNumbers()
{
    static const int NUMBERS[CODES_PER_BLOCK] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15};
    return vx_load(NUMBERS);
}

//! The lanes with a negative value.
CV_ALWAYS_INLINE int negativeLanes(const Counts* values)
{
    int lanes = 0;
    for (int v = 0; v < VECTORS; v++)
        lanes |= v_signmask(values[v]) << v * WIDTH;
    return lanes;
}

#if IIB_LOOKS_UP_BYTES && !IIB_COUNTS_LANES
// By tables in registers, if a byte lookup is faster than counting the bits of words.

const CodePacking PACKING = PACKING_TABLES;
// Queries compared at once with a CodeBlock: as many as registers hold sums for. Scans with lists use fewer.
const int QUERIES = 8, LISTED_QUERIES = 4;

// A vector holds POSITIONS bytes of each of the CODES_PER_BLOCK codes.
typedef v_uint8 Bytes;
const int BYTES = VTraits<Bytes>::max_nlanes, POSITIONS = BYTES / CODES_PER_BLOCK;

inline Bytes lowHalves(const Bytes& x) { return x & vx_setall_u8(15); }
inline Bytes highHalves(const Bytes& x)
{
    return lowHalves(v_reinterpret_as_u8(v_reinterpret_as_u16(x) >> 4));
}

//! The distances of two queries' half bytes to all half bytes; the second query's in the high half.
struct HalfDistances
{
    uchar of[256][16];  //!< by the first query's half byte + 16 * the second query's
    HalfDistances()
    {
        for (int i = 0; i < 256 * 16; i++)
            of[i / 16][i % 16] = (uchar)(countBits(i / 16 % 16 ^ i % 16) | countBits(i / 256 ^ i % 16) << 4);
    }
};

/** The queries that are compared at once, as tables: the distances of each half byte to those of train codes. Two queries
 share a table, in the low and in the high halves of its bytes. A vector of codes has tables for its low half bytes, then
 for its high ones. */
class QueryGroup
{
public:
    explicit QueryGroup(const CodeLayout& l) : bytes(4 * l.words()), tables(QUERIES / 2 * pairSize()) {}

    //! @param plain words of the first Q queries.
    template <int Q> void set(const unsigned* plain)
    {
        static const HalfDistances distances;
        for (int q = 0; q < Q; q += 2)
        {
            const uchar* const first = (const uchar*)plain + q * bytes;
            const uchar* const second = q + 1 < Q ? first + bytes : first;
            uchar* table = tables.data() + q / 2 * pairSize();
            for (int from = 0; from < bytes; from += POSITIONS, table += 2 * BYTES)
                for (int p = 0; p < POSITIONS; p++)
                {
                    const int a = first[from + p], b = second[from + p];
                    v_store(table + p * 16, v_load(distances.of[(a & 15) | (b & 15) << 4]));
                    v_store(table + p * 16 + BYTES, v_load(distances.of[a >> 4 | (b & 240)]));
                }
        }
    }

    //! The tables of two queries.
    const uchar* operator[](int pair) const { return tables.data() + pair * pairSize(); }

private:
    size_t pairSize() const { return (size_t)bytes * 2 * 16; }

    const int bytes;
    AlignedBuffer<uchar> tables;
};

//! The distances of Q queries to the codes of a CodeBlock, up to some word.
template <int Q> class BlockDistances
{
public:
    static constexpr int SIZE = Q * VECTORS, PAIRS = (Q + 1) / 2, WIDE = POSITIONS > 1 ? 1 : 2;

    //! Compares words 0 to `to`.
    CV_ALWAYS_INLINE void start(const QueryGroup& queries, const unsigned* block, int to)
    {
        for (int i = 0; i < SIZE; i++)
            counts[i] = vx_setzero_s32();
        advance(queries, block, 0, to);
    }

    //! Compares words `from` to `to`.
    CV_ALWAYS_INLINE void advance(const QueryGroup& queries, const unsigned* block, int from, int to)
    {
        for (; to - from > WIDEST; from += WIDEST)
            addWords(queries, block, from, from + WIDEST);
        addWords(queries, block, from, to);
    }

    CV_ALWAYS_INLINE void distances(Counts* result) const
    {
        for (int i = 0; i < SIZE; i++)
            result[i] = counts[i];
    }

private:
    static constexpr int WIDEST = 2000;  // words whose sum fits 16 bits: up to 2047 * 32 bits

    CV_ALWAYS_INLINE void addWords(const QueryGroup& queries, const unsigned* block, int from, int to)
    {
        const int MOST = 30;  // vectors whose sum fits a byte: up to 31 * 8 bits
        v_uint16 wide[Q * WIDE];
        for (int i = 0; i < Q * WIDE; i++)
            wide[i] = vx_setzero_u16();
        int v = from * 4 / POSITIONS;
        for (const int end = to * 4 / POSITIONS; v < end;)
        {
            const int next = std::min(v + MOST, end);
            Bytes low[PAIRS];
            v_uint16 high[PAIRS];
            for (int pair = 0; pair < PAIRS; pair++)
            {
                low[pair] = vx_setzero_u8();
                high[pair] = vx_setzero_u16();
            }
            for (; v + 3 <= next; v += 3)
                addVectors<3>(low, high, queries, block, v);
            for (; v < next; v++)
                addVectors<1>(low, high, queries, block, v);
            for (int pair = 0; pair < PAIRS; pair++)
            {
                widen(low[pair], wide + 2 * pair * WIDE);
                if (2 * pair + 1 < Q)
                    widen(highSums(low[pair], high[pair]), wide + (2 * pair + 1) * WIDE);
            }
        }
        for (int q = 0; q < Q; q++)
            for (int k = 0; k < WIDE; k++)
                addWide(wide[q * WIDE + k], counts + q * VECTORS + k * VECTORS / 2);
    }

    // A sum of N distances must fit half a byte. A distance is at most 4, so N is at most 3.
    template <int N>
    static CV_ALWAYS_INLINE void addVectors(
            Bytes* low, v_uint16* high, const QueryGroup& queries, const unsigned* block, int v)
    {
        for (int half = 0; half < 2; half++)
        {
            Bytes index[N];
            for (int n = 0; n < N; n++)
            {
                const Bytes code = vx_load((const uchar*)block + (v + n) * BYTES);
                index[n] = half == 0 ? lowHalves(code) : highHalves(code);
            }
            for (int pair = 0; pair < PAIRS; pair++)
            {
                const uchar* tables = queries[pair] + (2 * v + half) * BYTES;
                Bytes both = lookUp(vx_load(tables), index[0]);
                for (int n = 1; n < N; n++)
                    both = v_add_wrap(both, lookUp(vx_load(tables + 2 * n * BYTES), index[n]));
                low[pair] = v_add_wrap(low[pair], lowHalves(both));
                if (2 * pair + 1 < Q)
                    high[pair] = v_add_wrap(high[pair], v_reinterpret_as_u16(both) >> 4);
            }
        }
    }

    // addVectors() does not mask the high halves, so each sum also has 16 times the low half of every second byte. It is
    // subtracted here, once; exact modulo 2^16, since sums fit in bytes.
    static CV_ALWAYS_INLINE Bytes highSums(const Bytes& low, const v_uint16& high)
    {
        return v_reinterpret_as_u8(v_sub_wrap(high, (v_reinterpret_as_u16(low) >> 8) << 4));
    }

    // Adds up the positions of a vector.
    static CV_ALWAYS_INLINE void widen(const Bytes& sums, v_uint16* wide)
    {
        v_uint16 a, b;
        v_expand(sums, a, b);
        // a vector has POSITIONS values of each of the 16 codes: its halves, or quarters, are added
        wide[0] = wide[0] + (WIDE > 1 ? a : a + b);
        if (WIDE > 1)
            wide[WIDE - 1] = wide[WIDE - 1] + b;
    }

    static CV_ALWAYS_INLINE void addWide(const v_uint16& sums, Counts* counts)
    {
        v_uint32 a, b;
        v_expand(sums, a, b);
        counts[0] += v_reinterpret_as_s32(a);
        counts[POSITIONS > 2 ? 0 : 1] += v_reinterpret_as_s32(b);
    }

    Counts counts[SIZE];
};

#else
// By full adders, if bits of words are counted fast, or there is no byte lookup.

const CodePacking PACKING = PACKING_ADDERS;

const int QUERIES = WIDTH >= 16 ? 4 : WIDTH >= 8 ? 2 : 1, LISTED_QUERIES = QUERIES;

// Bit counts of words, in a form that is cheap to add; up to MOST are added before total().
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
class QueryGroup
{
public:
    explicit QueryGroup(const CodeLayout& l) : layout(l), codes(QUERIES * l.words()) {}

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

//! The distances of Q queries to the codes of a CodeBlock, up to some word. Loops run over all vectors, so that compilers
//! unroll them and keep everything in registers.
template <int Q> class BlockDistances
{
public:
    static constexpr int SIZE = Q * VECTORS;

    //! Compares words 0 to `to`.
    CV_ALWAYS_INLINE void start(const QueryGroup& queries, const unsigned* block, int to)
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
    CV_ALWAYS_INLINE void advance(const QueryGroup& queries, const unsigned* block, int from, int to)
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
            Partial* partial, const QueryGroup& queries, const unsigned* block, int from, int to)
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

#endif

}  // namespace
CV_CPU_OPTIMIZATION_NAMESPACE_END
}}  // namespace cv::iib
