// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// What all scans share. Included by hamming.simd.hpp.

namespace cv {
namespace iib {
CV_CPU_OPTIMIZATION_NAMESPACE_BEGIN
namespace {

class Scanner
{
public:
    explicit Scanner(const HammingScan& s) : scan(s), layout(*s.layout), queries(layout) {}

protected:
    template <int Q> void setQueries(int query)
    {
        for (int q = 0; q < Q; q++)
            queries.set(q, plainQuery(query + q));
    }

    //! Negative where a distance is small enough to be found.
    CV_ALWAYS_INLINE Counts beyond(int query, int group, int v, const Counts& distance) const
    {
        Counts below = vx_setall_s32(scan.queryBelow[query]);
        if (scan.trainBelow)
            below = v_max(below, vx_load(scan.trainBelow + group * CODES_PER_BLOCK + v * WIDTH));
        return distance - below;
    }

    void report(int query, int group, const Counts* distance, const Counts* beyonds) const
    {
        int lanes = negativeLanes(beyonds);
        if (!lanes)
            return;
        Counts absent[VECTORS];
        for (int v = 0; v < VECTORS; v++)
            absent[v] = missing(query, group, v);
        lanes &= ~negativeLanes(absent);
        int near[CODES_PER_BLOCK];
        storeLanes(near, distance, lanes);
        for (int i = 0; lanes; lanes &= lanes - 1)
            scan.sink->found(query, group * CODES_PER_BLOCK + trailingZeros32(lanes), near[i++]);
    }

    //! All bits of the lanes whose pairs do not exist.
    CV_ALWAYS_INLINE Counts missing(int query, int group, int v) const
    {
        if (!scan.allowed)
            return vx_setzero_s32();
        const uchar* allowed = scan.allowed + ((size_t)query * scan.groups + group) * CODES_PER_BLOCK;
        return v_reinterpret_as_s32(vx_load_expand_q(allowed + v * WIDTH)) == vx_setzero_s32();
    }

    const unsigned* codes(int group) const
    {
        return scan.trains + (size_t)group * layout.words() * CODES_PER_BLOCK;
    }
    const unsigned* plainQuery(int query) const { return scan.queries + (size_t)query * layout.words(); }

    const HammingScan& scan;
    const CodeLayout& layout;
    TileQueries queries;
};

//! Every pair to the end, but for tiles whose pairs are all surely too far apart before.
class FullScanner : public Scanner
{
public:
    explicit FullScanner(const HammingScan& s) : Scanner(s), early(layout.words())
    {
        // In both directions some pair is nearly always near enough; PACKING_ADDERS wants an odd number.
        if (!s.trainBelow && layout.bytes() > 64)
            early = layout.words() * 7 / 10 | 1;
    }

    //! Some queries against all groups.
    template <int Q> void row(int query)
    {
        setQueries<Q>(query);
        // Looking is given up where too few tiles end: it costs about a sixth of what each of them saves.
        for (int group = 0, ended = 0; group < scan.groups; group++)
            ended += compare<Q>(query, group, group <= 8 + 6 * ended ? early : layout.words());
    }

private:
    //! Returns whether the tile ended after `end` words, before the last.
    template <int Q> CV_ALWAYS_INLINE bool compare(int query, int group, int end)
    {
        Tile<Q> tile;
        Counts distance[Tile<Q>::SIZE], beyonds[Tile<Q>::SIZE];
        tile.start(queries, codes(group), end);
        bool near = anyNear<Q>(tile, query, group, distance, beyonds);
        if (end < layout.words())
        {
            if (!near)
                return true;
            tile.advance(queries, codes(group), end, layout.words());
            near = anyNear<Q>(tile, query, group, distance, beyonds);
        }
        for (int q = 0; q < Q && near; q++)
            report(query + q, group, distance + q * VECTORS, beyonds + q * VECTORS);
        return false;
    }

    template <int Q>
    CV_ALWAYS_INLINE bool anyNear(
            const Tile<Q>& tile, int query, int group, Counts* distance, Counts* beyonds) const
    {
        Counts any = vx_setzero_s32();
        tile.distances(distance);
        for (int i = 0; i < Tile<Q>::SIZE; i++)
        {
            beyonds[i] = beyond(query + i / VECTORS, group, i % VECTORS, distance[i]);
            any = any | beyonds[i];
        }
        return v_check_any(any);
    }

    int early;  // words after which a tile is left if no pair is near enough so far: distances only grow
};

}  // namespace
CV_CPU_OPTIMIZATION_NAMESPACE_END
}  // namespace iib
}  // namespace cv
