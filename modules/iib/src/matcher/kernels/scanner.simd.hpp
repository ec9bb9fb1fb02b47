// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// Base of all scans: prepares some queries, and says which pairs exist.

#pragma once

#include "hamming.hpp"
#include "block_distances.simd.hpp"

namespace cv { namespace iib {
CV_CPU_OPTIMIZATION_NAMESPACE_BEGIN
namespace {

class Scanner
{
public:
    explicit Scanner(const CodePairs& p)
        : pairs(p), layout(p.layout), queries(layout), blocks(p.blocks()), plain(QUERIES * layout.words())
    {
    }

protected:
    template <int Q> void setQueries(int query)
    {
        for (int q = 0; q < Q; q++)
            layout.arrange(pairs.queries.ptr(query + q), plain.data() + q * layout.words());
        queries.set<Q>(plain.data());
    }
    //! The plain words of query q of setQueries().
    const unsigned* plainQuery(int q) const { return plain.data() + q * layout.words(); }

    //! Whether missing() may be negative.
    bool incomplete(int block) const { return pairs.allowed || block == blocks - 1; }
    //! Negative in the lanes whose pairs do not exist or are masked.
    CV_ALWAYS_INLINE Counts missing(int query, int block, int v) const
    {
        Counts result = vx_setzero_s32();
        if (block == blocks - 1)
            result =
                    vx_setall_s32(pairs.trainCount - 1 - block * CODES_PER_BLOCK - v * WIDTH) - laneNumbers();
        if (pairs.allowed)
        {
            const uchar* allowed = pairs.allowed + ((size_t)query * blocks + block) * CODES_PER_BLOCK;
            result = result |
                     (v_reinterpret_as_s32(vx_load_expand_q(allowed + v * WIDTH)) == vx_setzero_s32());
        }
        return result;
    }

    const unsigned* codes(int block) const { return pairs.trains + block * layout.blockWords(); }

    const CodePairs& pairs;
    const CodeLayout& layout;
    QueryGroup queries;
    const int blocks;

private:
    AutoBuffer<unsigned> plain;
};

}  // namespace
CV_CPU_OPTIMIZATION_NAMESPACE_END
}}  // namespace cv::iib
