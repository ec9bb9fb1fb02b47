// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// Comparison of single pairs, part by part. Included by hamming.simd.hpp.

#include "../../common/aligned_buffer.hpp"
#include "../../common/simd.hpp"

namespace cv {
namespace iib {
CV_CPU_OPTIMIZATION_NAMESPACE_BEGIN
namespace {

// Single pairs are compared row by row: plain levels of ROW_WORDS words of 64 bits or a multiple.
#if CV_AVX512_ICL
const int ROW_WORDS = 8;
inline int countDifferences(const uint64* a, const uint64* b, int words)
{
    v_uint32 count = v_popcount(v_reinterpret_as_u32(vx_load(a) ^ vx_load(b)));
    for (int i = ROW_WORDS; i < words; i += ROW_WORDS)
        count += v_popcount(v_reinterpret_as_u32(vx_load(a + i) ^ vx_load(b + i)));
    return (int)v_reduce_sum(count);
}
#elif CV_POPCNT && (defined __x86_64__ || defined _M_X64)
const int ROW_WORDS = 1;
inline int countDifferences(const uint64* a, const uint64* b, int words)
{
    int64 count = 0;
    for (int i = 0; i < words; i++)
        count += _mm_popcnt_u64(a[i] ^ b[i]);
    return (int)count;
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

//! Parts of codes, from one on, each filled up with zeros to whole vectors, to compare pairs part by part.
class Rows
{
public:
    Rows(const CodeLayout& l, int first_, int rows)
        : layout(l), first(first_), plain(l.words()), known(rows, 0)
    {
        starts.assign(first + 1, 0);
        for (int part = first; part < layout.parts(); part++)
            starts.push_back(starts[part] + (int)alignSize((size(part) + 1) / 2, ROW_WORDS));
        step = starts.back();
        words.allocate((size_t)rows * step);
    }

    //! Words of 64 bits from the end of a part to the end of another.
    int count(int from, int to) const { return starts[to + 1] - starts[from + 1]; }
    //! What follows a part.
    const uint64* after(int part, int row) const { return start(row) + starts[part + 1]; }

    void set(int row, const unsigned* code)
    {
        for (int part = first; part < layout.parts(); part++)
        {
            const unsigned* end = code + layout.end(part);
            unsigned* filled = std::copy(end - size(part), end, (unsigned*)(start(row) + starts[part]));
            std::fill(filled, (unsigned*)(start(row) + starts[part + 1]), 0u);
        }
        known[row] = 1;
    }
    //! Sets a row out of groups, unless that was done.
    void require(int row, const unsigned* groups)
    {
        if (known[row])
            return;
        layout.fetch(groups + (size_t)row / CODES_PER_BLOCK * CODES_PER_BLOCK * layout.words(),
                row % CODES_PER_BLOCK, plain.data());
        set(row, plain.data());
    }

private:
    int size(int part) const { return layout.end(part) - (part ? layout.end(part - 1) : 0); }
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
