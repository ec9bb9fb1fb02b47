// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "hamming.hpp"

namespace cv { namespace iib {
CV_CPU_OPTIMIZATION_NAMESPACE_BEGIN
const HammingKernels& hammingKernels();
CV_CPU_OPTIMIZATION_NAMESPACE_END
}}  // namespace cv::iib

#ifndef CV_CPU_OPTIMIZATION_DECLARATIONS_ONLY

#include "scan_pruned.simd.hpp"

namespace cv { namespace iib {
CV_CPU_OPTIMIZATION_NAMESPACE_BEGIN
namespace {

/** The COUNT nearest of each query and, if needed, the nearest of each train code. A pair's key is its distance, followed by
an index in the low bits: the least key is that of the nearest pair, ties to the first. So no result needs a branch. */
template <int COUNT> class NearestScanner : public Scanner
{
public:
    explicit NearestScanner(const NearestScan& s)
        : Scanner(s.pairs), scan(s), trains(s.ofTrains ? s.pairs.paddedTrains() : 0), trainKeys(trains)
    {
        std::fill(trainKeys.data(), trainKeys.data() + trains, int(NO_KEY));
    }

    //! Compares Q queries with all blocks.
    template <int Q> void row(int query)
    {
        setQueries<Q>(query);
        Counts nearest[COUNT][BlockDistances<Q>::SIZE];
        for (int i = 0; i < COUNT * BlockDistances<Q>::SIZE; i++)
            nearest[i / BlockDistances<Q>::SIZE][i % BlockDistances<Q>::SIZE] = vx_setall_s32(NO_KEY);
        for (int block = 0; block < blocks; block++)
            compare<Q>(query, block, nearest);
        for (int n = 0; n < COUNT; n++)
            for (int i = 0; i < BlockDistances<Q>::SIZE; i++)
                keepOfQuery(query + i / VECTORS, i % VECTORS * WIDTH, nearest[n][i]);
    }

    //! After the last row.
    void keepOfTrains() const
    {
        for (int train = 0; trains > 0 && train < pairs.trainCount; train++)
            keep(scan.ofTrains + train, 1, trainKeys.data()[train],
                    scan.firstQuery + (trainKeys.data()[train] & INDEX_MASK));
    }

private:
    static constexpr int BITS = NearestScan::SMALL_INDEX_BITS, INDEX_MASK = (1 << BITS) - 1, NO_KEY = INT_MAX;

    template <int Q>
    CV_ALWAYS_INLINE void compare(int query, int block, Counts (&nearest)[COUNT][BlockDistances<Q>::SIZE])
    {
        BlockDistances<Q> tile;
        Counts keys[BlockDistances<Q>::SIZE];
        tile.start(queries, codes(block), layout.words());
        tile.distances(keys);
        for (int i = 0; i < BlockDistances<Q>::SIZE; i++)
            keys[i] = keys[i] << BITS;
        if (incomplete(block))
            for (int i = 0; i < BlockDistances<Q>::SIZE; i++)
                keys[i] = v_select(missing(query + i / VECTORS, block, i % VECTORS) < vx_setzero_s32(),
                        vx_setall_s32(NO_KEY), keys[i]);
        for (int i = 0; i < BlockDistances<Q>::SIZE; i++)
        {
            const Counts key = keys[i] | vx_setall_s32(block);
            if (COUNT > 1)
                nearest[COUNT - 1][i] = v_min(nearest[COUNT - 1][i], v_max(nearest[0][i], key));
            nearest[0][i] = v_min(nearest[0][i], key);
        }
        for (int v = 0; v < VECTORS && trains > 0; v++)
        {
            int* const ofTrains = trainKeys.data() + block * CODES_PER_BLOCK + v * WIDTH;
            Counts least = vx_load(ofTrains);
            for (int q = 0; q < Q; q++)
                least = v_min(least, keys[q * VECTORS + v] | vx_setall_s32(query + q));
            v_store(ofTrains, least);
        }
    }

    void keepOfQuery(int query, int firstLane, const Counts& keys) const
    {
        int all[WIDTH];
        v_store(all, keys);
        for (int lane = 0; lane < WIDTH; lane++)
            keep(scan.ofQueries + (size_t)query * COUNT, COUNT, all[lane],
                    scan.firstTrain + (all[lane] & INDEX_MASK) * CODES_PER_BLOCK + firstLane + lane);
    }

    //! Inserts a pair into the `count` nearest ones.
    static void keep(MatchKey* nearest, int count, int key, size_t index)
    {
        MatchKey n = key == NO_KEY ? NO_MATCH : matchKey(key >> BITS, index);
        for (int i = 0; i < count; i++)
        {
            const MatchKey before = nearest[i];
            nearest[i] = std::min(before, n);
            n = std::max(before, n);
        }
    }

    const NearestScan& scan;
    const int trains;  // 0 if only queries have neighbours
    AlignedBuffer<int> trainKeys;
};

//! Processes Q queries at a time, then the remainder in smaller groups.
template <int Q, class S> void scanAll(S&& scanner, int queryCount)
{
    int q = 0;
    for (; q + Q <= queryCount; q += Q)
        scanner.template row<Q>(q);
    for (; q + LISTED_QUERIES <= queryCount; q += LISTED_QUERIES)
        scanner.template row<LISTED_QUERIES>(q);
    for (; q < queryCount; q++)
        scanner.template row<1>(q);
}

template <int COUNT> void nearestOfEach(const NearestScan& scan)
{
    NearestScanner<COUNT> scanner(scan);
    scanAll<QUERIES>(scanner, scan.pairs.queries.rows);
    scanner.keepOfTrains();
}

void nearest(const NearestScan& scan) { scan.count == 1 ? nearestOfEach<1>(scan) : nearestOfEach<2>(scan); }

void pruned(const PrunedScan& scan) { scanAll<LISTED_QUERIES>(PrunedScanner(scan), scan.pairs.queries.rows); }

}  // namespace

const HammingKernels& hammingKernels()
{
    static const HammingKernels kernels = {PACKING, nearest, pruned, IIB_INSTRUCTION_SET};
    return kernels;
}

CV_CPU_OPTIMIZATION_NAMESPACE_END
}}  // namespace cv::iib

#endif
