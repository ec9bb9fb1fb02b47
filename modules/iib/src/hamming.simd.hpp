// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "hamming.hpp"
#include "opencv2/core/hal/intrin.hpp"

namespace cv {
namespace iib {
CV_CPU_OPTIMIZATION_NAMESPACE_BEGIN

void hammingScan(const HammingScan& scan);
const char* hammingInstructionSet();

#ifndef CV_CPU_OPTIMIZATION_DECLARATIONS_ONLY

namespace {

typedef v_uint32 Words;
typedef v_int32 Counts;
const int LANES = HammingLayout::LANES, WIDTH = Words::nlanes, VECTORS = LANES / WIDTH;

// Queries compared at once with a group: as many as the registers hold.
#if CV_SIMD_WIDTH == 64
const int QUERIES = 4;
#elif CV_SIMD_WIDTH == 32
const int QUERIES = 2;
#else
const int QUERIES = 1;
#endif

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
inline Partial countBits(const Words& x)
{
#if CV_SSSE3 && CV_SIMD_WIDTH == 16
    const __m128i table = _mm_setr_epi8(0, 1, 1, 2, 1, 2, 2, 3, 1, 2, 2, 3, 2, 3, 3, 4), low = _mm_set1_epi8(15);
    return v_uint8(_mm_add_epi8(_mm_shuffle_epi8(table, _mm_and_si128(x.val, low)),
                                _mm_shuffle_epi8(table, _mm_and_si128(_mm_srli_epi16(x.val, 4), low))));
#else
    return v_popcount(v_reinterpret_as_u8(x));
#endif
}
inline Counts total(const Partial& x)
{
    return v_reinterpret_as_s32(v_dotprod_expand(x, vx_setall_u8(1)));
}
#endif

// A step's full adder: returns the carry, turns the parity into the next.
inline Words addStep(Words& parity, const Words& train0, const Words& query0, const Words& train1, const Words& query1)
{
    const Words before = parity, x = train0 ^ query0;
#if CV_AVX512_SKX
    parity = Words(_mm512_ternarylogic_epi32(before.val, train1.val, query1.val, 0x96)); // xor of the three
    return Words(_mm512_ternarylogic_epi32(before.val, x.val, parity.val, 0x74));
#else
    const Words y = train1 ^ query1;
    parity = before ^ y;
    return before ^ (x & ~y);
#endif
}

//! Q queries against a group, compared up to some step. Its loops run over all vectors in one go, so that
//! compilers unroll them and keep everything in registers.
template<int Q> struct Tile
{
    enum { SIZE = Q * VECTORS };
    Words parity[SIZE];
    Counts carries[SIZE];

    // Compares steps 0 to `to`.
    CV_ALWAYS_INLINE void start(const unsigned* query, const unsigned* group, size_t words, int to)
    {
        for (int i = 0; i < SIZE; i++)
            parity[i] = vx_load(group + i % VECTORS * WIDTH) ^ vx_setall_u32(query[i / VECTORS * words]);
        const int first = std::min(to, MOST);
        Partial partial[SIZE];
        addSteps(partial, query, group, words, 0, first);
        for (int i = 0; i < SIZE; i++)
            carries[i] = total(partial[i]);
        advance(query, group, words, first, to);
    }

    // Compares steps `from` to `to`.
    CV_ALWAYS_INLINE void advance(const unsigned* query, const unsigned* group, size_t words, int from, int to)
    {
        while (from < to)
        {
            const int next = std::min(from + MOST, to);
            Partial partial[SIZE];
            addSteps(partial, query, group, words, from, next);
            for (int i = 0; i < SIZE; i++)
                carries[i] += total(partial[i]);
            from = next;
        }
    }

    CV_ALWAYS_INLINE void addSteps(Partial* partial, const unsigned* query, const unsigned* group, size_t words,
                                   int from, int to)
    {
        for (int i = 0; i < SIZE; i++)
            partial[i] = noBits();
        for (; from < to; from++)
            for (int i = 0; i < SIZE; i++)
            {
                const unsigned* q = query + i / VECTORS * words + 1 + 2 * from;
                const unsigned* t = group + i % VECTORS * WIDTH + (1 + 2 * from) * LANES;
                const Words carry =
                        addStep(parity[i], vx_load(t), vx_setall_u32(q[0]), vx_load(t + LANES), vx_setall_u32(q[1]));
                partial[i] += countBits(carry);
            }
    }

    CV_ALWAYS_INLINE void distances(Counts* result) const
    {
        for (int i = 0; i < SIZE; i++)
            result[i] = carries[i] + carries[i] + total(countBits(parity[i]));
    }
};

class Scanner
{
public:
    explicit Scanner(const HammingScan& s) : scan(s), words(1 + 2 * s.steps), alive(s.stopCount * WIDTH)
    {
        std::fill(alive.begin(), alive.end(), 0u);
    }

    void run()
    {
        int q = 0;
        for (; q + QUERIES <= scan.queryCount; q += QUERIES)
            row<QUERIES>(q);
        for (; q < scan.queryCount; q++)
            row<1>(q);
        for (int i = 0; i < scan.stopCount * WIDTH; i++)
            scan.passed[i / WIDTH] += alive[i];
    }

private:
    template<int Q> void row(int query)
    {
        for (int group = 0; group < scan.groups; group++)
            compare<Q>(query, group);
    }

    template<int Q> CV_ALWAYS_INLINE void compare(int query, int group)
    {
        const unsigned* queryCode = scan.queries + query * words;
        const unsigned* groupCode = scan.trains + group * words * LANES;
        Tile<Q> tile;
        tile.start(queryCode, groupCode, words, scan.stopCount ? scan.stops[0].steps : scan.steps);
        if (scan.stopCount == 0)
        {
            report(tile, query, group);
            return;
        }
        for (int q = 0; q < Q; q++)
        {
            Tile<1> single;
            for (int v = 0; v < VECTORS; v++)
            {
                single.parity[v] = tile.parity[q * VECTORS + v];
                single.carries[v] = tile.carries[q * VECTORS + v];
            }
            descend(single, query + q, group);
        }
    }

    // From the first stop to the end, with one query.
    void descend(Tile<1>& t, int query, int group)
    {
        const unsigned* queryCode = scan.queries + query * words;
        const unsigned* groupCode = scan.trains + group * words * LANES;
        Counts dead[VECTORS], before[VECTORS], distance[VECTORS]; // dead: negative
        for (int v = 0; v < VECTORS; v++)
        {
            dead[v] = missing(query, group * LANES + v * WIDTH);
            before[v] = vx_setzero_s32();
        }
        for (int i = 0; i < scan.stopCount; i++)
        {
            const HammingStop& stop = scan.stops[i];
            if (i > 0)
                t.advance(queryCode, groupCode, words, scan.stops[i - 1].steps, stop.steps);
            t.distances(distance);
            for (int v = 0; v < VECTORS; v++)
            {
                dead[v] = dead[v] | (vx_setall_s32(stop.levelMax) - (distance[v] - before[v]));
                before[v] = distance[v];
            }
            int& limit = scan.limits[query * scan.stopCount + i];
            if (stop.margin >= 0)
                limit = std::min(limit, least(distance, dead, limit - stop.margin) + stop.margin);
            Counts allDead = vx_setall_s32(-1);
            for (int v = 0; v < VECTORS; v++)
            {
                dead[v] = dead[v] | (vx_setall_s32(limit) - distance[v]);
                allDead = allDead & dead[v];
                unsigned* counter = &alive[i * WIDTH];
                v_store(counter, vx_load(counter) + v_shr<31>(v_reinterpret_as_u32(~dead[v])));
            }
            if (v_check_all(allDead))
                return;
        }
        t.advance(queryCode, groupCode, words, scan.stops[scan.stopCount - 1].steps, scan.steps);
        t.distances(distance);
        for (int v = 0; v < VECTORS; v++)
        {
            const int train = group * LANES + v * WIDTH;
            found(query, train, distance[v], beyond(query, train, distance[v]) & ~dead[v]);
        }
    }

    template<int Q> CV_ALWAYS_INLINE void report(const Tile<Q>& t, int query, int group)
    {
        const int size = Tile<Q>::SIZE;
        Counts distance[size], near[size], any = vx_setzero_s32();
        t.distances(distance);
        for (int i = 0; i < size; i++)
        {
            near[i] = beyond(query + i / VECTORS, group * LANES + i % VECTORS * WIDTH, distance[i]);
            any = any | near[i];
        }
        if (!v_check_any(any))
            return;
        for (int i = 0; i < size; i++)
            if (v_check_any(near[i]))
            {
                const int q = query + i / VECTORS, train = group * LANES + i % VECTORS * WIDTH;
                found(q, train, distance[i], near[i] & ~missing(q, train));
            }
    }

    // Negative where a distance is small enough to be found.
    Counts beyond(int query, int train, const Counts& distance) const
    {
        return distance - v_max(vx_setall_s32(scan.queryBelow[query]), vx_load(scan.trainBelow + train));
    }

    // Negative where the pair does not exist.
    Counts missing(int query, int train) const
    {
        if (!scan.allowed)
            return vx_setzero_s32();
        const uchar* allowed = scan.allowed + (size_t)query * scan.groups * LANES + train;
        return v_reinterpret_as_s32(vx_load_expand_q(allowed)) - vx_setall_s32(1);
    }

    static int least(const Counts* distance, const Counts* dead, int below)
    {
        Counts any = vx_setzero_s32();
        for (int v = 0; v < VECTORS; v++)
            any = any | ((distance[v] - vx_setall_s32(below)) & ~dead[v]);
        if (!v_check_any(any))
            return below;
        Counts result = vx_setall_s32(below);
        for (int v = 0; v < VECTORS; v++)
            result = v_min(result, v_select(dead[v] < vx_setzero_s32(), result, distance[v]));
        return v_reduce_min(result);
    }

    void found(int query, int train, const Counts& distance, const Counts& near) const
    {
        int distances[WIDTH];
        v_store(distances, distance);
        for (int lanes = v_signmask(near); lanes; lanes &= lanes - 1)
        {
            const int lane = trailingZeros32(lanes);
            scan.sink->found(query, train + lane, distances[lane]);
        }
    }

    const HammingScan& scan;
    const size_t words;
    std::vector<unsigned> alive; // stop by stop, lane by lane: the pairs that went on
};

}  // namespace

void hammingScan(const HammingScan& scan)
{
    Scanner(scan).run();
}

const char* hammingInstructionSet()
{
#ifdef CV_CPU_DISPATCH_MODE
    return CVAUX_STR(CV_CPU_DISPATCH_MODE);
#else
    return "baseline";
#endif
}

#endif

CV_CPU_OPTIMIZATION_NAMESPACE_END
}  // namespace iib
}  // namespace cv
