// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#pragma once

#include "../../common/vectors.simd.hpp"
#include "kernels.hpp"

namespace cv {
namespace iib {

CV_CPU_OPTIMIZATION_NAMESPACE_BEGIN

namespace {

/* A group is the four channels of a pixel. loadGroups() loads groups from several places into one vector, nextGroups() shifts
 a vector by one group. Vectors have 256 bits at most: the offsets of a 512-bit one need too many registers. v_lut_quads is
 not used, since gather instructions are slow on many machines. */
#if CV_AVX2
typedef v_uint16x16 v_groups16;
typedef v_uint32x8 v_groups32;

//! Four places: row + at[0], at[2], at[4], at[6].
inline v_groups16 loadGroups(const ushort* row, const size_t* at)
{
    const __m128i low = v_load_halves(row + at[0], row + at[2]).val;
    return v_groups16(_mm256_inserti128_si256(
            _mm256_castsi128_si256(low), v_load_halves(row + at[4], row + at[6]).val, 1));
}

//! Two places: row + at[0], at[2].
inline v_groups32 loadGroups(const unsigned* row, const size_t* at)
{
    const __m256i low = _mm256_castsi128_si256(v_load(row + at[0]).val);
    return v_groups32(_mm256_inserti128_si256(low, v_load(row + at[2]).val, 1));
}

//! Drops the first group and appends the one at `more`.
inline v_groups16 nextGroups(const v_groups16& v, const ushort* more)
{
    return v_rotate_right<4>(v, v_groups16(_mm256_castsi128_si256(v_load_low(more).val)));
}

inline v_groups32 nextGroups(const v_groups32& v, const unsigned* more)
{
    return v_rotate_right<4>(v, v_groups32(_mm256_castsi128_si256(v_load(more).val)));
}
#else
typedef v_uint16x8 v_groups16;
typedef v_uint32x4 v_groups32;

//! Two places: row + at[0], at[2].
inline v_groups16 loadGroups(const ushort* row, const size_t* at)
{
    return v_load_halves(row + at[0], row + at[2]);
}

//! One place: row + at[0].
inline v_groups32 loadGroups(const unsigned* row, const size_t* at) { return v_load(row + at[0]); }

//! Drops the first group and appends the one at `more`.
inline v_groups16 nextGroups(const v_groups16& v, const ushort* more)
{
    return v_rotate_right<4>(v, v_groups16(v_load_low(more)));
}

inline v_groups32 nextGroups(const v_groups32&, const unsigned* more) { return v_load(more); }
#endif

inline v_groups16 subtractModulo(const v_groups16& a, const v_groups16& b) { return v_sub_wrap(a, b); }
inline v_groups32 subtractModulo(const v_groups32& a, const v_groups32& b) { return a - b; }

/* n is a power of two, so that the edges of a level are a subset of those of the next. The compiler makes vectors of
 the loop, with this file's instruction set. */
void cellEdges(Point2d corner, double side, int n, Rect bounds, CellEdges& edges)
{
    int *const x = edges.x, *const y = edges.y;
    const double step = side / n;
    const Point first = bounds.tl(), end = bounds.br();
    for (int k = 0; k < n; k++)
    {
        x[k] = edgeAt(corner.x + step * k, first.x, end.x);
        y[k] = edgeAt(corner.y + step * k, first.y, end.y);
    }
    x[n] = edgeAt(corner.x + step * n, first.x, end.x);
    y[n] = edgeAt(corner.y + step * n, first.y, end.y);
    for (int k = n + 1; k < paddedEdges(n); k++)
        x[k] = x[n];
}

//! Sums over left and right cells and all pixels above them: differences of neighbouring corners in a row.
template <typename V> struct RowSums
{
    V left, right;

    template <typename Sum, size_t N> CV_ALWAYS_INLINE RowSums(const Sum* row, const size_t (&at)[N])
    {
        const V even = loadGroups(row, at), odd = loadGroups(row, at + 1);
        left = subtractModulo(odd, even);
        right = subtractModulo(nextGroups(even, row + at[N - 1]), odd);
    }
};

//! The row of the ring that ends above row y of the image.
template <typename Sum> class RowFinder
{
public:
    RowFinder(const RingRows<Sum>& rows, int top)
        : data(rows.data), step(rows.step), count(rows.count), shift((top - rows.origin.y) % count - top)
    {
    }

    const Sum* operator()(int y) const
    {
        const int place = y + shift;
        return data + (place < count ? place : place - count) * step;
    }

private:
    const Sum* const data;
    const size_t step;
    const int count, shift;
};

template <typename Sum>
void cellSums(const RingRows<Sum>& rows, const int* xEdges, const int* yEdges, int n, CellGrid<Sum>& cells)
{
    typedef decltype(loadGroups(rows.data, (const size_t*)0)) V;
    constexpr int COLUMNS = 2 * VTraits<V>::max_nlanes / GROUP_CHANNELS;
    const RowFinder<Sum> row(rows, yEdges[0]);
    AutoBuffer<const Sum*, 64> lines(n);
    for (int r = 0; r < n; r++)
        lines[r] = row(yEdges[r + 1]);

    cells.create(n);
    const size_t step = cells.row(0, 1) - cells.row(0, 0);
    for (int c = 0; c < n; c += COLUMNS)
    {
        size_t at[COLUMNS + 1];
        for (int i = 0; i <= COLUMNS; i++)
            at[i] = (size_t)(xEdges[c + i] - rows.origin.x) * GROUP_CHANNELS;
        Sum* out = cells.row(0, 0) + c / 2 * GROUP_CHANNELS;
        RowSums<V> above(row(yEdges[0]), at);
        for (const Sum *const *line = lines.data(), *const *end = line + n; line != end; line++)
        {
            const RowSums<V> below(*line, at);
            v_store(out, subtractModulo(below.left, above.left));
            v_store(out + step, subtractModulo(below.right, above.right));
            out += 2 * step;
            above = below;
        }
    }
}

}  // namespace

// Where one instruction picks bytes out of a whole vector.
#if CV_AVX512_ICL && IIB_NATIVE_VECTORS
#define IIB_SUMS_SEGMENTS 1

namespace {

//! Sums over eight segments of a row that follow each other, of four rows at once.
class SegmentSums
{
public:
    static constexpr int COUNT = 8;
    static constexpr int LONGEST = 4;  //!< values of a segment that are summed: the first ones,
    static constexpr int REACH = 32;   //!< and only those among so many first ones of all segments

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
    const RowFinder<short> row(rows, yEdges[0]);
    AutoBuffer<const ushort*, 72> lines(n + 1);
    for (int r = 0; r <= n; r++)
        lines[r] = reinterpret_cast<const ushort*>(row(yEdges[r]));
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
#define IIB_SUMS_SEGMENTS 0
#endif

CV_CPU_OPTIMIZATION_NAMESPACE_END

}  // namespace iib
}  // namespace cv
