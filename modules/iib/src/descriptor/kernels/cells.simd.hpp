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

/* A group is the four channels of a pixel. loadGroups() loads groups from several places into one vector, nextGroups()
 shifts a vector by one group. Vectors have 256 bits at most: the offsets of a 512-bit one need too many registers.
 v_lut_quads is not used, since gather instructions are slow on many machines. */
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

template <typename Sum>
void cellSums(const RingRows<Sum>& rows, const int* xEdges, const int* yEdges, int n, CellGrid<Sum>& cells)
{
    typedef decltype(loadGroups(rows.data, (const size_t*)0)) V;
    constexpr int COLUMNS = 2 * VTraits<V>::max_nlanes / GROUP_CHANNELS;
    const int count = rows.count, shift = rows.shift(yEdges[0]);
    const auto row = [&](int y) { return rows.data + rows.place(y + shift, count) * rows.step; };
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

CV_CPU_OPTIMIZATION_NAMESPACE_END

}  // namespace iib
}  // namespace cv
