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

// Single pairs are compared row by row: plain levels of ROW_WORDS words or a multiple.
#if IIB_COUNTS_LANES
const int ROW_WORDS = WIDTH;
inline int countDifferences(const unsigned* a, const unsigned* b, int words)
{
    v_uint32 count = v_popcount(vx_load(a) ^ vx_load(b));
    for (int i = ROW_WORDS; i < words; i += ROW_WORDS)
        count += v_popcount(vx_load(a + i) ^ vx_load(b + i));
    return (int)v_reduce_sum(count);
}
#elif IIB_COUNTS_64_BITS
const int ROW_WORDS = 2;
inline int countDifferences(const unsigned* a, const unsigned* b, int words)
{
    int count = 0;
    for (int i = 0; i < words; i += ROW_WORDS)
    {
        uint64 x, y;
        memcpy(&x, a + i, sizeof(x));
        memcpy(&y, b + i, sizeof(y));
        count += countBits64(x ^ y);
    }
    return count;
}
#else
const int ROW_WORDS = 4;
inline int countDifferences(const unsigned* a, const unsigned* b, int words)
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
        : layout(l), first(first_), plain(l.words()), starts(l.segments() + 1), known(rows)
    {
        for (int segment = 0; segment <= layout.segments(); segment++)
            starts[segment] = segment <= first ? 0 : starts[segment - 1] + paddedSize(segment - 1);
        step = starts[layout.segments()];
        memset(known.data(), 0, rows);
        words.allocate((size_t)rows * step);
    }

    //! Words from the end of a segment to the end of another.
    int count(int from, int to) const { return starts[to + 1] - starts[from + 1]; }
    //! What follows a segment.
    const unsigned* after(int segment, int row) const
    {
        return words.data() + (size_t)row * step + starts[segment + 1];
    }

    void set(int row, const unsigned* code)
    {
        for (int segment = first; segment < layout.segments(); segment++)
        {
            unsigned* const to = words.data() + (size_t)row * step;
            const unsigned* end = code + layout.end(segment);
            unsigned* filled = std::copy(end - size(segment), end, to + starts[segment]);
            std::fill(filled, to + starts[segment + 1], 0u);
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
    int paddedSize(int segment) const { return (int)alignSize(size(segment), ROW_WORDS); }

    const CodeLayout& layout;
    const int first;
    AutoBuffer<unsigned> plain;
    AutoBuffer<int> starts;  // of each segment in a row, and the end
    int step;
    AutoBuffer<uchar> known;  // whether a row was set
    AlignedBuffer<unsigned> words;
};

}  // namespace
CV_CPU_OPTIMIZATION_NAMESPACE_END
}  // namespace iib
}  // namespace cv

#endif
