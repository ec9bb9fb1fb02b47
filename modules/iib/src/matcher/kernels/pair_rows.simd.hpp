// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// Comparison of single pairs, segment by segment.

#ifndef OPENCV_IIB_MATCHER_KERNELS_PAIR_ROWS_SIMD_HPP
#define OPENCV_IIB_MATCHER_KERNELS_PAIR_ROWS_SIMD_HPP

#include "../../common/aligned_buffer.hpp"
#include "count_vectors.simd.hpp"

namespace cv {
namespace iib {
CV_CPU_OPTIMIZATION_NAMESPACE_BEGIN
namespace {

// Single pairs are compared row by row: plain levels of ROW_WORDS words of 64 bits or a multiple.
#if IIB_COUNTS_LANES
const int ROW_WORDS = WIDTH / 2;
inline int countDifferences(const uint64* a, const uint64* b, int words)
{
    v_uint32 count = v_popcount(v_reinterpret_as_u32(vx_load(a) ^ vx_load(b)));
    for (int i = ROW_WORDS; i < words; i += ROW_WORDS)
        count += v_popcount(v_reinterpret_as_u32(vx_load(a + i) ^ vx_load(b + i)));
    return (int)v_reduce_sum(count);
}
#elif IIB_COUNTS_64_BITS
const int ROW_WORDS = 1;
inline int countDifferences(const uint64* a, const uint64* b, int words)
{
    int count = 0;
    for (int i = 0; i < words; i++)
        count += countBits64(a[i] ^ b[i]);
    return count;
}
#else
const int ROW_WORDS = 2;
inline int countDifferences(const uint64* a, const uint64* b, int words)
{
    unsigned count = 0;
    for (int i = 0; i < words; i += ROW_WORDS)
        count += v_reduce_sum(v_popcount(v_reinterpret_as_u8(v_load(a + i) ^ v_load(b + i))));
    return (int)count;
}
#endif

//! Segments of codes, from one on, each filled up with zeros to whole vectors, to compare pairs segment by segment.
class PairRows
{
public:
    PairRows(const CodeLayout& l, int first_, int rows)
        : layout(l), first(first_), plain(l.words()), known(rows, 0)
    {
        starts.assign(first + 1, 0);
        for (int segment = first; segment < layout.segments(); segment++)
            starts.push_back(starts[segment] + (int)alignSize((size(segment) + 1) / 2, ROW_WORDS));
        step = starts.back();
        words.allocate((size_t)rows * step);
    }

    //! Words of 64 bits from the end of a segment to the end of another.
    int count(int from, int to) const { return starts[to + 1] - starts[from + 1]; }
    //! What follows a segment.
    const uint64* after(int segment, int row) const { return start(row) + starts[segment + 1]; }

    void set(int row, const unsigned* code)
    {
        for (int segment = first; segment < layout.segments(); segment++)
        {
            const unsigned* end = code + layout.end(segment);
            unsigned* filled = std::copy(end - size(segment), end, (unsigned*)(start(row) + starts[segment]));
            std::fill(filled, (unsigned*)(start(row) + starts[segment + 1]), 0u);
        }
        known[row] = 1;
    }
    //! Sets a row from packed codes, unless that was done.
    void require(int row, const unsigned* blocks)
    {
        if (known[row])
            return;
        layout.fetch(
                blocks + row / CODES_PER_BLOCK * layout.blockWords(), row % CODES_PER_BLOCK, plain.data());
        set(row, plain.data());
    }

private:
    int size(int segment) const { return layout.end(segment) - (segment ? layout.end(segment - 1) : 0); }
    uint64* start(int row) const { return const_cast<uint64*>(words.data()) + (size_t)row * step; }

    const CodeLayout& layout;
    const int first;
    AutoBuffer<unsigned> plain;
    std::vector<int> starts;
    int step;
    std::vector<uchar> known;
    AlignedBuffer<uint64> words;
};

}  // namespace
CV_CPU_OPTIMIZATION_NAMESPACE_END
}  // namespace iib
}  // namespace cv

#endif
