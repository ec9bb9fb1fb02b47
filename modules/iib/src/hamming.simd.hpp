// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "hamming.hpp"
#include "intrinsics.hpp"

namespace cv {
namespace iib {
CV_CPU_OPTIMIZATION_NAMESPACE_BEGIN

void hammingScan(const HammingScan& scan);
const char* hammingInstructionSet();

#ifndef CV_CPU_OPTIMIZATION_DECLARATIONS_ONLY

namespace {

typedef v_uint32 Words;
typedef v_int32 Counts;
const int LANES = HammingLayout::LANES, WIDTH = VTraits<Words>::max_nlanes, VECTORS = LANES / WIDTH;

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

inline int countLanes(int lanes)
{
#if CV_POPCNT
    return _mm_popcnt_u32(lanes);
#else
    int count = 0;
    for (; lanes; lanes &= lanes - 1)
        count++;
    return count;
#endif
}

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
    Counts carries[SIZE], before[SIZE]; // before: the distance at the stop before

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

//! A query's comparison with a group, put aside at a stop.
struct Pending
{
    enum { SIZE = 4 * LANES }; // whole cache lines
    int *state, *query, *group, *alive;

    explicit Pending(int* memory)
        : state(memory), query(memory + 3 * LANES), group(query + 1), alive(query + 2) {}

    template<int Q> CV_ALWAYS_INLINE void store(const Tile<Q>& tile, int q) const
    {
        for (int v = 0; v < VECTORS; v++)
        {
            const int i = q * VECTORS + v;
            v_store(state + v * WIDTH, v_reinterpret_as_s32(tile.parity[i]));
            v_store(state + LANES + v * WIDTH, tile.carries[i]);
            v_store(state + 2 * LANES + v * WIDTH, tile.before[i]);
        }
    }
    CV_ALWAYS_INLINE void load(Tile<1>& tile) const
    {
        for (int v = 0; v < VECTORS; v++)
        {
            tile.parity[v] = v_reinterpret_as_u32(vx_load(state + v * WIDTH));
            tile.carries[v] = vx_load(state + LANES + v * WIDTH);
            tile.before[v] = vx_load(state + 2 * LANES + v * WIDTH);
        }
    }
};

class Scanner
{
public:
    explicit Scanner(const HammingScan& s)
        : scan(s), words(1 + 2 * s.steps), together(0), memory((size_t)QUERIES * s.groups * Pending::SIZE + LANES),
          places(alignPtr(memory.data(), LANES * sizeof(int)))
    {
        // The first stops, one soon after the other, are for whole tiles: hardly any tile ends there.
        while (together < scan.stopCount && (together == 0 || stepsAt(together) - stepsAt(together - 1) <= 2))
            together++;
    }

    void run()
    {
        int q = 0;
        for (; q + QUERIES <= scan.queryCount; q += QUERIES)
            row<QUERIES>(q);
        for (; q < scan.queryCount; q++)
            row<1>(q);
    }

private:
    // Stop by stop over all groups, so that each loop does one thing: what survives a stop is put aside.
    template<int Q> void row(int query)
    {
        int pending = 0;
        for (int group = 0; group < scan.groups; group++)
            compare<Q>(query, group, pending);
        for (int stop = together; stop <= scan.stopCount && pending > 0; stop++)
            pending = resume(stop, pending);
    }

    template<int Q> CV_ALWAYS_INLINE void compare(int query, int group, int& pending)
    {
        Tile<Q> tile;
        tile.start(queryCode(query), groupCode(group), words, stepsAt(0));
        if (scan.stopCount == 0)
        {
            report(tile, query, group);
            return;
        }
        int alive[Q];
        for (int q = 0; q < Q; q++)
            alive[q] = existing(query + q, group);
        for (int i = 0; i < Tile<Q>::SIZE; i++)
            tile.before[i] = vx_setzero_s32();
        for (int stop = 0; stop < together; stop++)
        {
            if (stop > 0)
                tile.advance(queryCode(query), groupCode(group), words, stepsAt(stop - 1), stepsAt(stop));
            keep(tile, query, stop, alive);
        }
        for (int q = 0; q < Q; q++)
        {
            if (!alive[q])
                continue;
            const Pending place(places + (size_t)pending * Pending::SIZE);
            place.store(tile, q);
            *place.query = query + q;
            *place.group = group;
            *place.alive = alive[q];
            pending++;
        }
    }

    // Takes all that is pending to a stop, or to the end after the last; returns how many are left.
    int resume(int stop, int pending)
    {
        int left = 0;
        for (int i = 0; i < pending; i++)
        {
            const Pending from(places + (size_t)i * Pending::SIZE), to(places + (size_t)left * Pending::SIZE);
            const int query = *from.query, group = *from.group;
            int alive = *from.alive;
            Tile<1> tile;
            from.load(tile);
            tile.advance(queryCode(query), groupCode(group), words, stepsAt(stop - 1), stepsAt(stop));
            if (stop == scan.stopCount)
            {
                report(tile, query, group, alive);
                continue;
            }
            keep(tile, query, stop, &alive);
            to.store(tile, 0);
            *to.query = query;
            *to.group = group;
            *to.alive = alive;
            left += alive != 0;
        }
        return left;
    }

    // Applies a stop to the lanes alive.
    template<int Q> CV_ALWAYS_INLINE void keep(Tile<Q>& tile, int query, int stop, int* alive)
    {
        Counts distance[Tile<Q>::SIZE];
        tile.distances(distance);
        int* limits = scan.limits + query * scan.stopCount + stop;
        if (scan.stops[stop].margin >= 0)
            for (int q = 0; q < Q; q++)
                lower(limits[q * scan.stopCount], distance + q * VECTORS, alive[q], scan.stops[stop].margin);
        const Counts levelMax = vx_setall_s32(scan.stops[stop].levelMax);
        int above[Q], pairs = 0;
        for (int q = 0; q < Q; q++)
            above[q] = 0;
        for (int i = 0; i < Tile<Q>::SIZE; i++)
        {
            const Counts most = v_min(tile.before[i] + levelMax, vx_setall_s32(limits[i / VECTORS * scan.stopCount]));
            above[i / VECTORS] |= v_signmask(most - distance[i]) << i % VECTORS * WIDTH;
        }
        for (int q = 0; q < Q; q++)
            pairs += countLanes(alive[q] &= ~above[q]);
        for (int i = 0; i < Tile<Q>::SIZE; i++)
            tile.before[i] = distance[i];
        scan.passed[stop] += pairs;
    }

    // Brings a limit down to the least distance of the lanes alive plus a margin.
    static CV_ALWAYS_INLINE void lower(int& limit, const Counts* distance, int alive, int margin)
    {
        int below = 0;
        for (int v = 0; v < VECTORS; v++)
            below |= v_signmask(distance[v] - vx_setall_s32(limit - margin)) << v * WIDTH;
        if (below & alive)
            limit = least(distance, below & alive) + margin;
    }

    static int least(const Counts* distance, int lanes)
    {
        int distances[LANES], result = INT_MAX;
        for (int v = 0; v < VECTORS; v++)
            v_store(distances + v * WIDTH, distance[v]);
        for (; lanes; lanes &= lanes - 1)
            result = std::min(result, distances[trailingZeros32(lanes)]);
        return result;
    }

    template<int Q> CV_ALWAYS_INLINE void report(const Tile<Q>& tile, int query, int group) const
    {
        Counts distance[Tile<Q>::SIZE], beyonds[Tile<Q>::SIZE], any = vx_setzero_s32();
        tile.distances(distance);
        for (int i = 0; i < Tile<Q>::SIZE; i++)
        {
            beyonds[i] = beyond(query + i / VECTORS, group, i % VECTORS, distance[i]);
            any = any | beyonds[i];
        }
        if (!v_check_any(any))
            return;
        for (int q = 0; q < Q; q++)
            found(query + q, group, distance + q * VECTORS, beyonds + q * VECTORS, existing(query + q, group));
    }

    void report(const Tile<1>& tile, int query, int group, int alive) const
    {
        Counts distance[VECTORS], beyonds[VECTORS];
        tile.distances(distance);
        for (int v = 0; v < VECTORS; v++)
            beyonds[v] = beyond(query, group, v, distance[v]);
        found(query, group, distance, beyonds, alive);
    }

    // Negative where a distance is small enough to be found.
    CV_ALWAYS_INLINE Counts beyond(int query, int group, int v, const Counts& distance) const
    {
        const int* trainBelow = scan.trainBelow + group * LANES + v * WIDTH;
        return distance - v_max(vx_setall_s32(scan.queryBelow[query]), vx_load(trainBelow));
    }

    void found(int query, int group, const Counts* distance, const Counts* beyonds, int lanes) const
    {
        int distances[LANES];
        int near = 0;
        for (int v = 0; v < VECTORS; v++)
        {
            v_store(distances + v * WIDTH, distance[v]);
            near |= v_signmask(beyonds[v]) << v * WIDTH;
        }
        for (lanes &= near; lanes; lanes &= lanes - 1)
        {
            const int lane = trailingZeros32(lanes);
            scan.sink->found(query, group * LANES + lane, distances[lane]);
        }
    }

    // The lanes whose pairs exist.
    CV_ALWAYS_INLINE int existing(int query, int group) const
    {
        int lanes = (1 << LANES) - 1;
        if (!scan.allowed)
            return lanes;
        const uchar* allowed = scan.allowed + ((size_t)query * scan.groups + group) * LANES;
        for (int v = 0; v < VECTORS; v++)
        {
            const Counts missing = v_reinterpret_as_s32(vx_load_expand_q(allowed + v * WIDTH)) - vx_setall_s32(1);
            lanes &= ~(v_signmask(missing) << v * WIDTH);
        }
        return lanes;
    }

    // Steps compared at a stop, or in all after the last.
    int stepsAt(int stop) const { return stop < scan.stopCount ? scan.stops[stop].steps : scan.steps; }
    const unsigned* queryCode(int query) const { return scan.queries + query * words; }
    const unsigned* groupCode(int group) const { return scan.trains + group * words * LANES; }

    const HammingScan& scan;
    const size_t words;
    int together; // stops at which tiles stay whole
    AutoBuffer<int> memory;
    int* places;
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
