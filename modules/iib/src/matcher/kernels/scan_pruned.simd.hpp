// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// Scans with stops, part by part. Included by hamming.simd.hpp.

namespace cv {
namespace iib {
CV_CPU_OPTIMIZATION_NAMESPACE_BEGIN
namespace {

class PrunedScanner : public Scanner
{
public:
    explicit PrunedScanner(const HammingScan& s)
        : Scanner(s), queryRow(layout, partAt(0) + 1, 1),
          trainRows(layout, partAt(0) + 1, s.groups * CODES_PER_BLOCK)
    {
        for (int stop = 0; stop <= s.stopCount; stop++)
            words.push_back(layout.end(partAt(stop)));
        distances.allocate((size_t)QUERIES * s.groups * CODES_PER_BLOCK);
        shortlists.allocate(
                (size_t)QUERIES * (s.groups + 1) * CODES_PER_BLOCK);  // storeLanes() needs more than fits
    }

    //! Some queries against all groups: all pairs together up to a stop; then those that pass one by one, or all
    //! to the next stop if they are many.
    template <int Q> void row(int query)
    {
        setQueries<Q>(query);
        // Two stops in one go if the second comes soon after the first, where hardly any tile would end.
        int stop = scan.stopCount > 1 && words[1] - words[0] <= 4 ? 1 : 0;
        if (stop == 0)
            compareTo<Q, 1>(query, stop);
        else
            compareTo<Q, 2>(query, stop);
        for (; stop < scan.stopCount; compareTo<Q, 0>(query, ++stop))
        {
            int counts[Q], pairs = 0;
            select<Q>(query, stop, counts);
            for (int q = 0; q < Q; q++)
                pairs += counts[q];
            scan.passed[stop] += pairs;
            if (pairs * 8 > scan.groups * words[stop + 1] * Q)
                continue;
            for (int q = 0; q < Q; q++)
                finish(query + q, q, counts[q], stop);
            return;
        }
        for (int q = 0; q < Q; q++)
            for (int group = 0; group < scan.groups; group++)
            {
                Counts distance[VECTORS], beyonds[VECTORS];
                for (int v = 0; v < VECTORS; v++)
                {
                    distance[v] = vx_load(distancesOf(q) + group * CODES_PER_BLOCK + v * WIDTH);
                    beyonds[v] = beyond(query + q, group, v, distance[v]);
                }
                report(query + q, group, distance, beyonds);
            }
    }

private:
    enum
    {
        NEVER = INT_MAX
    };

    //! Writes the distances up to a stop, NEVER for pairs that ended on the way. STOPS is the number of stops up
    //! to there if those that passed at the ones before are to be counted, else 0.
    template <int Q, int STOPS> void compareTo(int query, int stop)
    {
        const int groups = scan.groups, first = words[0], second = words[1];
        const size_t step = layout.words() * CODES_PER_BLOCK;
        const unsigned* group = scan.trains;
        int *results = distances.data(), *const end = results + groups * CODES_PER_BLOCK;
        Counts gone = vx_setzero_s32(), minima[Q];
        for (int q = 0; q < Q; q++)
            minima[q] = vx_setall_s32(NEVER);
        for (int g = 0; results != end; results += CODES_PER_BLOCK, group += step, g++)
        {
            Tile<Q> tile;
            Counts distance[Tile<Q>::SIZE], before[Tile<Q>::SIZE], room[Tile<Q>::SIZE];
            for (int i = 0; i < Tile<Q>::SIZE; i++)
            {
                before[i] = vx_setzero_s32();
                room[i] = missing(query + i / VECTORS, g, i % VECTORS);
            }
            tile.start(queries, group, first);
            tile.distances(distance);
            if (STOPS == 2)
            {
                endPairs<Q>(0, 0, distance, before, room);
                for (int i = 0; i < Tile<Q>::SIZE; i++)
                    gone += room[i] >> 31;
                tile.advance(queries, group, first, second);
                tile.distances(distance);
                endPairs<Q>(1, 0, distance, before, room);
            }
            if (STOPS == 0)
            {
                for (int i = 0; i < stop; i++)
                {
                    endPairs<Q>(i, scan.limits ? scan.limits + query : 0, distance, before, room);
                    tile.advance(queries, group, words[i], words[i + 1]);
                    tile.distances(distance);
                }
                if (stop < scan.stopCount)
                    endPairs<Q>(stop, 0, distance, before, room);
            }
            for (int i = 0; i < Tile<Q>::SIZE; i++)
            {
                if (STOPS != 1 || scan.allowed)
                    distance[i] = v_select(room[i] < vx_setzero_s32(), vx_setall_s32(NEVER), distance[i]);
                v_store(results + i / VECTORS * groups * CODES_PER_BLOCK + i % VECTORS * WIDTH, distance[i]);
                if (STOPS == 1)
                    minima[i / VECTORS] = v_min(minima[i / VECTORS], distance[i]);
            }
        }
        if (STOPS == 1)
            for (int q = 0; q < Q; q++)
                least[q] = v_reduce_min(minima[q]);
        if (STOPS == 2)
            scan.passed[0] += Q * groups * CODES_PER_BLOCK + v_reduce_sum(gone);
    }

    //! Makes the room negative of the pairs that are not to go on at a stop.
    template <int Q>
    CV_ALWAYS_INLINE void endPairs(
            int stop, const int* limits, const Counts* distance, Counts* before, Counts* room) const
    {
        const Counts most = vx_setall_s32(scan.stops[stop].most);
        for (int i = 0; i < Tile<Q>::SIZE; i++)
        {
            room[i] = room[i] | (before[i] + most - distance[i]);
            if (limits)
                room[i] = room[i] | (vx_setall_s32(limits[i / VECTORS]) - distance[i]);
            before[i] = distance[i];
        }
    }

    //! Lists the pairs of each query that go on.
    template <int Q> void select(int query, int stop, int* counts)
    {
        const int size = scan.groups * CODES_PER_BLOCK;
        const int* distance[Q];
        int *list[Q], limits[Q];
        for (int q = 0; q < Q; q++)
        {
            distance[q] = distancesOf(q);
            list[q] = shortlist(q);
            limits[q] = lowerLimit(query + q, q, stop);
        }
        for (int i = 0; i < size; i += CODES_PER_BLOCK)
        {
            Counts trains[VECTORS];
            for (int v = 0; v < VECTORS; v++)
                trains[v] = laneNumbers() + vx_setall_s32(i + v * WIDTH);
            for (int q = 0; q < Q; q++)
            {
                Counts room[VECTORS];
                for (int v = 0; v < VECTORS; v++)
                    room[v] = vx_setall_s32(limits[q]) - vx_load(distance[q] + i + v * WIDTH);
                const int lanes = ((1 << CODES_PER_BLOCK) - 1) & ~negativeLanes(room);
                storeLanes(list[q], trains, lanes);
                list[q] += countLanes(lanes);
            }
        }
        for (int q = 0; q < Q; q++)
            counts[q] = (int)(list[q] - shortlist(q));
    }

    //! The most that may differ at the stop.
    int lowerLimit(int query, int q, int stop)
    {
        const int most = stop == 0 ? scan.stops[0].most : NEVER - 1;  // which was not looked at, or was
        if (!scan.limits)
            return most;
        int& limit = scan.limits[query];
        if (scan.margin >= 0)
            limit = std::min(limit, std::min(least[q], NEVER - scan.margin) + scan.margin);
        return std::min(limit, most);
    }

    //! Takes the pairs of a list one by one through the stops that follow.
    void finish(int query, int q, int count, int stop)
    {
        if (count > 0)
            queryRow.set(0, plainQuery(query));
        for (; stop < scan.stopCount && count > 0; stop++)
        {
            if (stop + 1 < scan.stopCount)
                scan.passed[stop + 1] += count = advance(q, count, stop);
            else
                advance(q, count, stop);
        }
        const int *list = shortlist(q), *distance = distancesOf(q), *queryBelow = scan.queryBelow + query;
        const int* trainBelow = scan.trainBelow;
        for (int i = 0; i < count; i++)
            if (distance[list[i]] < *queryBelow || (trainBelow && distance[list[i]] < trainBelow[list[i]]))
                scan.sink->found(query, list[i], distance[list[i]]);
    }

    //! Compares the pairs of a list to the stop after a stop; returns how many are left.
    int advance(int q, int count, int stop)
    {
        const int from = partAt(stop), to = partAt(stop + 1);
        const int most = stop + 1 < scan.stopCount ? scan.stops[stop + 1].most : NEVER;
        const int size = queryRow.count(from, to);
        const uint64* query = queryRow.after(from, 0);
        int *list = shortlist(q), *distance = distancesOf(q), left = 0;
        for (int i = 0; i < count; i++)
        {
            const int train = list[i];
            trainRows.require(train, scan.trains);
            const int more = countDifferences(query, trainRows.after(from, train), size);
            distance[train] += more;
            list[left] = train;
            left += more <= most;
        }
        return left;
    }

    //! The part that ends at a stop, or the last one after the last stop.
    int partAt(int stop) const { return stop < scan.stopCount ? scan.stops[stop].part : layout.parts() - 1; }
    int* distancesOf(int q) { return distances.data() + (size_t)q * scan.groups * CODES_PER_BLOCK; }
    int* shortlist(int q) { return shortlists.data() + (size_t)q * (scan.groups + 1) * CODES_PER_BLOCK; }

    Rows queryRow, trainRows;
    std::vector<int> words;                    // up to each stop, and in all
    AlignedBuffer<int> distances, shortlists;  // of a row's pairs
    int least[QUERIES];                        // of the distances
};

}  // namespace
CV_CPU_OPTIMIZATION_NAMESPACE_END
}  // namespace iib
}  // namespace cv
