// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#pragma once

#include "cells.simd.hpp"

namespace cv {
namespace iib {

CV_CPU_OPTIMIZATION_NAMESPACE_BEGIN

// Where one instruction picks bytes out of a whole vector.
#if CV_AVX512_ICL && IIB_NATIVE_VECTORS

namespace {

//! Sums over eight segments of a row that follow each other, of four rows at once.
class SegmentSums
{
public:
    static constexpr int COUNT = 8;
    static constexpr int LONGEST = 4;  //!< at most this many values of a segment are summed
    static constexpr int REACH = 32;   //!< all segments have to lie within this many values

    //! @param edges COUNT + 1 of them, where the segments begin and end.
    explicit SegmentSums(const int* edges)
    {
        const __m256i first = _mm256_set1_epi32(edges[0]);
        const __m256i begin = _mm256_sub_epi32(_mm256_loadu_si256((const __m256i*)edges), first);
        const __m256i end = _mm256_sub_epi32(_mm256_loadu_si256((const __m256i*)(edges + 1)), first);
        const __m256i reached = _mm256_min_epi32(
                _mm256_add_epi32(begin, _mm256_set1_epi32(LONGEST)), _mm256_set1_epi32(REACH));
        complete = _mm256_cmpgt_epi32_mask(end, reached) == 0;

        const __m512i places = _mm512_add_epi16(
                fourTimes(begin), _mm512_set_epi64(0x0003000300030003, 0x0003000300030003, 0x0002000200020002,
                                          0x0002000200020002, 0x0001000100010001, 0x0001000100010001, 0, 0));
        const __m512i index = _mm512_add_epi16(
                _mm512_mullo_epi16(places, _mm512_set1_epi16(0x0202)), _mm512_set1_epi16(0x0100));
        const __m512i within =
                _mm512_movm_epi16(_mm512_cmplt_epi16_mask(places, fourTimes(_mm256_min_epi32(end, reached))));
        // the quarters of a vector hold the first values, the second ... of each segment, in an order for each row
        picked[0] = Picked{index, _mm512_movepi8_mask(within)};
        picked[1] = picked[0].ordered<0x4e>(within);
        picked[2] = picked[0].ordered<0xb1>(within);
        picked[3] = picked[0].ordered<0x1b>(within);
    }

    //! Whether each segment is summed whole.
    bool areComplete() const { return complete; }

    //! The end of what is summed of segment i.
    static int reached(const int* edges, int i)
    {
        return std::max(std::min(edges[i] + LONGEST, edges[0] + REACH), edges[i]);
    }

    //! The sums, those of row + at[0] first, modulo 2^16.
    v_uint16 operator()(const ushort* row, const size_t at[4]) const
    {
        const __m512i a = pick(0, row + at[0]), b = pick(1, row + at[1]), c = pick(2, row + at[2]),
                      d = pick(3, row + at[3]);
        const __m512i ab =
                _mm512_add_epi16(_mm512_mask_blend_epi64(0xf0, a, b), _mm512_shuffle_i64x2(a, b, 0x4e));
        const __m512i cd =
                _mm512_add_epi16(_mm512_mask_blend_epi64(0xf0, c, d), _mm512_shuffle_i64x2(c, d, 0x4e));
        const __m512i rest = _mm512_mask_blend_epi64(0x33, ab, cd);
        return v_uint16(_mm512_add_epi16(
                _mm512_mask_blend_epi64(0xcc, ab, cd), _mm512_shuffle_i64x2(rest, rest, 0xb1)));
    }

    //! Stores those of segments 0, 2, 4, 6 to `even`, all rows' of one side by side, and the others to `odd`.
    static void store(ushort* even, ushort* odd, const v_uint16& sums)
    {
        const __m512i bytes = _mm512_set_epi64(0x3f3e1f1e2f2e0f0e, 0x3b3a1b1a2b2a0b0a, 0x3736171627260706,
                0x3332131223220302, 0x3d3c1d1c2d2c0d0c, 0x3938191829280908, 0x3534151425240504,
                0x3130111021200100);
        const v_uint16 sorted(_mm512_permutexvar_epi8(bytes, sums.val));
        v_store_low(even, sorted);
        v_store_high(odd, sorted);
    }

private:
    struct Picked
    {
        __m512i index;
        __mmask64 within;

        template <int ORDER> Picked ordered(const __m512i& bytesWithin) const
        {
            return Picked{_mm512_shuffle_i64x2(index, index, ORDER),
                    _mm512_movepi8_mask(_mm512_shuffle_i64x2(bytesWithin, bytesWithin, ORDER))};
        }
    };

    static __m512i fourTimes(const __m256i& v) { return _mm512_broadcast_i32x4(_mm256_cvtepi32_epi16(v)); }

    __m512i pick(int i, const ushort* p) const
    {
        return _mm512_maskz_permutexvar_epi8(picked[i].within, picked[i].index, _mm512_loadu_si512(p));
    }

    Picked picked[4];
    bool complete;
};

//! Adds a pixel column, all channels of it, to a column of cells.
void addColumn(const ushort* const* lines, const size_t channels[GROUP_CHANNELS], int x, int c,
        CellGrid<ushort>& cells)
{
    for (int r = 0; r < cells.size(); r++)
        for (int i = 0; i < GROUP_CHANNELS; i++)
        {
            const size_t at = channels[i] + x;
            ushort& sum = cells.cell(r, c)[i];
            sum = (ushort)(sum + lines[r + 1][at] - lines[r][at]);
        }
}

void columnCells(const RingRows<short>& rows, const size_t channels[GROUP_CHANNELS], const int* xEdges,
        const int* yEdges, int n, CellGrid<ushort>& cells)
{
    static_assert(NARROW_CELL == SegmentSums::LONGEST, "wider cells take longer");
    const int shift = rows.shift(yEdges[0]);
    AutoBuffer<const ushort*, 72> lines(n + 1);
    for (int r = 0; r <= n; r++)
        lines[r] = reinterpret_cast<const ushort*>(
                rows.data + rows.place(yEdges[r] + shift, rows.count) * rows.step);
    cells.create(n);
    const size_t step = cells.row(0, 1) - cells.row(0, 0);
    for (int c = 0; c < n; c += SegmentSums::COUNT)
    {
        const SegmentSums segments(xEdges + c);
        const size_t first = (size_t)(xEdges[c] - rows.origin.x);
        const size_t at[GROUP_CHANNELS] = {
                channels[0] + first, channels[1] + first, channels[2] + first, channels[3] + first};
        ushort* out = cells.row(0, 0) + c / 2 * GROUP_CHANNELS;
        v_uint16 above = segments(lines[0], at);
        for (int r = 0; r < n; r++, out += 2 * step)
        {
            const v_uint16 below = segments(lines[r + 1], at);
            segments.store(out, out + step, v_sub_wrap(below, above));
            above = below;
        }
        for (int k = 0; k < SegmentSums::COUNT && !segments.areComplete(); k++)
            for (int x = SegmentSums::reached(xEdges + c, k); x < xEdges[c + k + 1]; x++)
                addColumn(lines.data(), channels, x - rows.origin.x, c + k, cells);
    }
}

}  // namespace

#else

namespace {
constexpr decltype(DescriptorKernels::columnCells) columnCells = 0;
}

#endif

CV_CPU_OPTIMIZATION_NAMESPACE_END

}  // namespace iib
}  // namespace cv
