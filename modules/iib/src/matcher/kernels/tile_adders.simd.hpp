// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// Comparison of codes packed as PACKING_ADDERS, for instruction sets that count the bits of a word
// fast, or that have no tables in registers. Included by hamming.simd.hpp.

namespace cv {
namespace iib {
CV_CPU_OPTIMIZATION_NAMESPACE_BEGIN
namespace {

const CodePacking PACKING = PACKING_ADDERS;

// Queries compared at once with a group: as many as the registers hold.
const int QUERIES = CV_SIMD_WIDTH == 64 ? 4 : CV_SIMD_WIDTH == 32 ? 2 : 1;

// Bit counts of words, in a form that is cheap to compute; up to MOST may be added before total().
const int MOST = 31;
#if CV_AVX512_ICL
typedef v_uint32 Partial;
inline Partial noBits() { return vx_setzero_u32(); }
inline Partial countBits(const Words& x) { return v_popcount(x); }
inline Counts total(const Partial& x) { return v_reinterpret_as_s32(x); }
#else
typedef v_uint8 Partial;
inline Partial noBits() { return vx_setzero_u8(); }
inline Partial countBits(const Words& x) { return v_popcount(v_reinterpret_as_u8(x)); }
inline Counts total(const Partial& x) { return v_reinterpret_as_s32(v_dotprod_expand(x, vx_setall_u8(1))); }
#endif

// A full adder: returns the carry, turns the parity into the next.
inline Words addStep(
        Words& parity, const Words& train0, const Words& query0, const Words& train1, const Words& query1)
{
    const Words before = parity, x = train0 ^ query0;
#if CV_AVX512_SKX
    parity = Words(_mm512_ternarylogic_epi32(before.val, train1.val, query1.val, 0x96));  // xor of the three
    return Words(_mm512_ternarylogic_epi32(before.val, x.val, parity.val, 0x74));
#else
    const Words y = train1 ^ query1;
    parity = before ^ y;
    return before ^ (x & ~y);
#endif
}

//! The queries that are compared at once.
class TileQueries
{
public:
    explicit TileQueries(const CodeLayout& l) : layout(l), memory(QUERIES * l.words())
    {
        for (int i = 0; i < QUERIES; i++)
            codes[i] = memory.data() + i * l.words();
    }
    void set(int i, const unsigned* plain)
    {
        std::copy(plain, plain + layout.words(), codes[i]);
        layout.pack(codes[i]);
    }
    const unsigned* operator[](int i) const { return codes[i]; }

private:
    const CodeLayout& layout;
    AutoBuffer<unsigned> memory;
    unsigned* codes[QUERIES];
};

//! Q queries against a group, compared up to some word. Its loops run over all vectors in one go, so that
//! compilers unroll them and keep everything in registers.
template <int Q> class Tile
{
public:
    enum
    {
        SIZE = Q * VECTORS
    };

    //! Compares words 0 to `to`.
    CV_ALWAYS_INLINE void start(const TileQueries& queries, const unsigned* group, int to)
    {
        for (int i = 0; i < SIZE; i++)
            parity[i] = vx_load(group + i % VECTORS * WIDTH) ^ vx_setall_u32(queries[i / VECTORS][0]);
        const int first = std::min(to, 1 + 2 * MOST);
        Partial partial[SIZE];
        addSteps(partial, queries, group, 1, first);
        for (int i = 0; i < SIZE; i++)
            carries[i] = total(partial[i]);
        advance(queries, group, first, to);
    }

    //! Compares words `from` to `to`.
    CV_ALWAYS_INLINE void advance(const TileQueries& queries, const unsigned* group, int from, int to)
    {
        while (from < to)
        {
            const int next = std::min(from + 2 * MOST, to);
            Partial partial[SIZE];
            addSteps(partial, queries, group, from, next);
            for (int i = 0; i < SIZE; i++)
                carries[i] += total(partial[i]);
            from = next;
        }
    }

    CV_ALWAYS_INLINE void distances(Counts* result) const
    {
        for (int i = 0; i < SIZE; i++)
            result[i] = carries[i] + carries[i] + total(countBits(parity[i]));
    }

private:
    CV_ALWAYS_INLINE void addSteps(
            Partial* partial, const TileQueries& queries, const unsigned* group, int from, int to)
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
                const unsigned* t = group + i % VECTORS * WIDTH + from * CODES_PER_BLOCK;
                const Words carry = addStep(chain[i], vx_load(t), vx_setall_u32(q[0]),
                        vx_load(t + CODES_PER_BLOCK), vx_setall_u32(q[1]));
                sum[i] += countBits(carry);
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
