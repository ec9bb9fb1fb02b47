// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "hamming.hpp"

namespace cv {
namespace iib {
CV_CPU_OPTIMIZATION_NAMESPACE_BEGIN
const HammingKernels& hammingKernels();
CV_CPU_OPTIMIZATION_NAMESPACE_END
}  // namespace iib
}  // namespace cv

#ifndef CV_CPU_OPTIMIZATION_DECLARATIONS_ONLY

#include "scan_pruned.simd.hpp"

namespace cv {
namespace iib {
CV_CPU_OPTIMIZATION_NAMESPACE_BEGIN

namespace {

/** The nearest of each query and, if wanted, of each train code. A pair's key is its distance, followed by an index in
the low bits: the least key is that of the nearest pair, and of the first one if there are several. So no tile needs a
branch on what it found. */
class NearestScanner : public Scanner
{
public:
    explicit NearestScanner(const NearestScan& s)
        : Scanner(s.pairs), scan(s), trains(s.ofTrains ? s.pairs.paddedTrains() : 0), trainKeys(trains)
    {
        std::fill(trainKeys.data(), trainKeys.data() + trains, int(NO_KEY));
    }

    //! Some queries against all blocks.
    template <int Q> void row(int query)
    {
        setQueries<Q>(query);
        Counts nearest[Tile<Q>::SIZE];
        for (int i = 0; i < Tile<Q>::SIZE; i++)
            nearest[i] = vx_setall_s32(NO_KEY);
        for (int block = 0; block < blocks; block++)
            compare<Q>(query, block, nearest);
        for (int q = 0; q < Q; q++)
            keepOfQuery(query + q, nearest + q * VECTORS);
    }

    //! After the last row.
    void keepOfTrains() const
    {
        for (int train = 0; trains > 0 && train < pairs.trainCount; train++)
            keep(scan.ofTrains[train], trainKeys.data()[train],
                    scan.firstQuery + (trainKeys.data()[train] & INDEX_MASK));
    }

private:
    static constexpr int BITS = NearestScan::SMALL_INDEX_BITS, INDEX_MASK = (1 << BITS) - 1, NO_KEY = INT_MAX;

    template <int Q> CV_ALWAYS_INLINE void compare(int query, int block, Counts* nearest)
    {
        Tile<Q> tile;
        Counts keys[Tile<Q>::SIZE];
        tile.start(queries, codes(block), layout.words());
        tile.distances(keys);
        for (int i = 0; i < Tile<Q>::SIZE; i++)
            keys[i] = keys[i] << BITS;
        if (incomplete(block))
            for (int i = 0; i < Tile<Q>::SIZE; i++)
                keys[i] = v_select(missing(query + i / VECTORS, block, i % VECTORS) < vx_setzero_s32(),
                        vx_setall_s32(NO_KEY), keys[i]);
        for (int i = 0; i < Tile<Q>::SIZE; i++)
            nearest[i] = v_min(nearest[i], keys[i] | vx_setall_s32(block));
        for (int v = 0; v < VECTORS && trains > 0; v++)
        {
            int* const ofTrains = trainKeys.data() + block * CODES_PER_BLOCK + v * WIDTH;
            Counts least = vx_load(ofTrains);
            for (int q = 0; q < Q; q++)
                least = v_min(least, keys[q * VECTORS + v] | vx_setall_s32(query + q));
            v_store(ofTrains, least);
        }
    }

    void keepOfQuery(int query, const Counts* keys) const
    {
        Counts nearest = keys[0], others[VECTORS];
        for (int v = 1; v < VECTORS; v++)
            nearest = v_min(nearest, keys[v]);
        const int least = v_reduce_min(nearest);
        for (int v = 0; v < VECTORS; v++)
            others[v] = vx_setall_s32(least) - keys[v];
        const int lane = trailingZeros32(ALL_LANES & ~negativeLanes(others));
        keep(scan.ofQueries[query], least, scan.firstTrain + (least & INDEX_MASK) * CODES_PER_BLOCK + lane);
    }

    static void keep(MatchKey& nearest, int key, size_t index)
    {
        if (key != NO_KEY)
            nearest = std::min(nearest, matchKey(key >> BITS, index));
    }

    const NearestScan& scan;
    const int trains;  // 0 if only queries have neighbours
    AlignedBuffer<int> trainKeys;
};

template <class S> void scanAll(S&& scanner, int queryCount)
{
    int q = 0;
    for (; q + QUERIES <= queryCount; q += QUERIES)
        scanner.template row<QUERIES>(q);
    for (; q < queryCount; q++)
        scanner.template row<1>(q);
}

void nearest(const NearestScan& scan)
{
    NearestScanner scanner(scan);
    scanAll(scanner, scan.pairs.queries.rows);
    scanner.keepOfTrains();
}

void pruned(const PrunedScan& scan) { scanAll(PrunedScanner(scan), scan.pairs.queries.rows); }

}  // namespace

const HammingKernels& hammingKernels()
{
    static const HammingKernels kernels = {PACKING, nearest, pruned, IIB_INSTRUCTION_SET};
    return kernels;
}

CV_CPU_OPTIMIZATION_NAMESPACE_END
}  // namespace iib
}  // namespace cv

#endif
