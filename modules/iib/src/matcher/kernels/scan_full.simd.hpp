// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#ifndef OPENCV_IIB_MATCHER_KERNELS_SCAN_FULL_SIMD_HPP
#define OPENCV_IIB_MATCHER_KERNELS_SCAN_FULL_SIMD_HPP

#include "scanner.simd.hpp"

namespace cv {
namespace iib {
CV_CPU_OPTIMIZATION_NAMESPACE_BEGIN
namespace {

//! Exhaustive scan; skips the rest of a tile once no pair in it can qualify.
class FullScanner : public SinkScanner
{
public:
    FullScanner(const CodePairs& p, HammingSink& s) : SinkScanner(p, s), early(earlyEnd(!s.trainThresholds))
    {
    }

    //! Some queries against all blocks.
    template <int Q> void row(int query)
    {
        setQueries<Q>(query);
        // A look costs about a sixth of what an early end saves: stop looking where too few tiles end early.
        for (int block = 0, ended = 0; block < blocks; block++)
            ended += compare<Q>(query, block, block <= 8 + 6 * ended ? early : layout.words());
    }

private:
    //! Returns whether the tile ended after `end` words, before the last.
    template <int Q> CV_ALWAYS_INLINE bool compare(int query, int block, int end)
    {
        Tile<Q> tile;
        Counts distance[Tile<Q>::SIZE], slacks[Tile<Q>::SIZE];
        tile.start(queries, codes(block), end);
        bool near = anyNear<Q>(tile, query, block, distance, slacks);
        if (end < layout.words())
        {
            if (!near)
                return true;
            tile.advance(queries, codes(block), end, layout.words());
            near = anyNear<Q>(tile, query, block, distance, slacks);
        }
        for (int q = 0; q < Q && near; q++)
            collect(query + q, block, distance + q * VECTORS, slacks + q * VECTORS);
        return false;
    }

    template <int Q>
    CV_ALWAYS_INLINE bool anyNear(
            const Tile<Q>& tile, int query, int block, Counts* distance, Counts* slacks) const
    {
        Counts any = vx_setzero_s32();
        tile.distances(distance);
        for (int i = 0; i < Tile<Q>::SIZE; i++)
        {
            slacks[i] = slack(query + i / VECTORS, block, i % VECTORS, distance[i]);
            any = any | slacks[i];
        }
        return v_check_any(any);
    }

    const int early;
};

}  // namespace
CV_CPU_OPTIMIZATION_NAMESPACE_END
}  // namespace iib
}  // namespace cv

#endif
