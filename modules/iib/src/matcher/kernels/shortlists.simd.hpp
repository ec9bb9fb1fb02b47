// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// The distances of some queries to all train codes of a scan, and lists of those that pass a stage.

#ifndef OPENCV_IIB_MATCHER_KERNELS_SHORTLISTS_SIMD_HPP
#define OPENCV_IIB_MATCHER_KERNELS_SHORTLISTS_SIMD_HPP

#include "../../common/aligned_buffer.hpp"
#include "scanner.simd.hpp"

namespace cv {
namespace iib {
CV_CPU_OPTIMIZATION_NAMESPACE_BEGIN
namespace {

const int NEVER = INT_MAX;  // the distance of pairs that ended

class Shortlists
{
public:
    explicit Shortlists(int blocks)
        : rowSize((size_t)blocks * CODES_PER_BLOCK), listSize(rowSize + CODES_PER_BLOCK),
          values(QUERIES * rowSize), lists(QUERIES * listSize), stored(blocks), storedCount(0)
    {
    }

    //! Call this before storing distances. Those of blocks that are not appended afterwards count as NEVER.
    void clear() { storedCount = 0; }
    void store(int q, int block, int v, const Counts& distance)
    {
        v_store(distances(q) + block * CODES_PER_BLOCK + v * WIDTH, distance);
    }
    void append(int block) { stored[storedCount++] = block; }
    Counts load(int q, int block, int v) const
    {
        return vx_load(values.data() + q * rowSize + block * CODES_PER_BLOCK + v * WIDTH);
    }

    //! Lists the train codes of each query whose distance is at most its limit.
    template <int Q> void select(const int* limits, int* counts)
    {
        const int* distance[Q];
        int* end[Q];
        for (int q = 0; q < Q; q++)
        {
            distance[q] = distances(q);
            end[q] = list(q);
        }
        for (int i = 0; i < storedCount; i++)
        {
            const int train = stored[i] * CODES_PER_BLOCK;
            Counts trains[VECTORS];
            for (int v = 0; v < VECTORS; v++)
                trains[v] = laneNumbers() + vx_setall_s32(train + v * WIDTH);
            for (int q = 0; q < Q; q++)
            {
                Counts slack[VECTORS];
                for (int v = 0; v < VECTORS; v++)
                    slack[v] = vx_setall_s32(limits[q]) - vx_load(distance[q] + train + v * WIDTH);
                const int lanes = ALL_LANES & ~negativeLanes(slack);
                storeLanes(end[q], trains, lanes);
                end[q] += countBits(lanes);
            }
        }
        for (int q = 0; q < Q; q++)
            counts[q] = (int)(end[q] - list(q));
    }

    int* distances(int q) { return values.data() + q * rowSize; }
    //! storeLanes() writes beyond the end: there is room for a CodeBlock more.
    int* list(int q) { return lists.data() + q * listSize; }

private:
    const size_t rowSize, listSize;
    AlignedBuffer<int> values, lists;
    AutoBuffer<int> stored;  // blocks, ascending
    int storedCount;
};

}  // namespace
CV_CPU_OPTIMIZATION_NAMESPACE_END
}  // namespace iib
}  // namespace cv

#endif
