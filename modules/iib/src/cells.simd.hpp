// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "intrinsics.hpp"

#include "cells.hpp"
#include "quadtree.hpp"

namespace cv {
namespace iib {

CV_CPU_OPTIMIZATION_NAMESPACE_BEGIN

CellEdgesFunc getCellEdgesFunc();
CellSumsFunc<ushort>::Type getCellSumsFunc(ushort);
CellSumsFunc<unsigned>::Type getCellSumsFunc(unsigned);

#ifndef CV_CPU_OPTIMIZATION_DECLARATIONS_ONLY

namespace {

/* n is a power of two, so that the edges of a level are a subset of those of the next. The compiler makes vectors of
 the loop, with this file's instruction set. */
void cellEdges(double start, double side, int n, int limit, int* edges)
{
    const double step = side / n;
    for (int k = 0; k <= n; k++)
        edges[k] = edgeAt(start + step * k, limit);
}

inline v_uint16 load(const ushort* p) { return vx_load(p); }
inline v_uint32 load(const unsigned* p) { return vx_load(p); }

// Differences modulo 2^16 or 2^32, as the sums.
inline v_uint16 subtract(const v_uint16& a, const v_uint16& b) { return v_sub_wrap(a, b); }
inline v_uint32 subtract(const v_uint32& a, const v_uint32& b) { return a - b; }

inline v_uint16x8 loadCorner(const ushort* corner) { return v_load_low(corner); }
inline v_uint32x4 loadCorner(const unsigned* corner) { return v_load(corner); }

// What 128 bits hold of every other corner of a row: two corners or one.
inline v_uint16x8 loadCorners(const ushort* row, const size_t* offsets)
{
    return v_load_halves(row + offsets[0], row + offsets[2]);
}

inline v_uint32x4 loadCorners(const unsigned* row, const size_t* offsets)
{
    return v_load(row + offsets[0]);
}

//! As many corners as make a vector, of every other column. Not v_lut_quads: gather instructions are slow on many
//! machines.
template <typename V, typename Sum> inline V gatherCorners(const Sum* row, const size_t* offsets)
{
#if CV_SIMD_WIDTH == 16
    return loadCorners(row, offsets);
#else
    const int n = 2 * 16 / (GROUP_CHANNELS * (int)sizeof(Sum));  // columns
    const __m256i low = _mm256_inserti128_si256(_mm256_castsi128_si256(loadCorners(row, offsets).val),
                                                loadCorners(row, offsets + n).val, 1);
#if CV_SIMD_WIDTH == 32
    return V(low);
#else
    const __m256i high = _mm256_inserti128_si256(_mm256_castsi128_si256(loadCorners(row, offsets + 2 * n).val),
                                                 loadCorners(row, offsets + 3 * n).val, 1);
    return V(_mm512_inserti64x4(_mm512_castsi256_si512(low), high, 1));
#endif
#endif
}

//! The corners after the first one of a vector, and one more.
#if CV_SIMD_WIDTH == 16
inline v_uint16 nextCorners(const v_uint16& corners, const ushort* more)
{
    return v_rotate_right<GROUP_CHANNELS>(corners, loadCorner(more));
}

inline v_uint32 nextCorners(const v_uint32&, const unsigned* more) { return loadCorner(more); }
#else
template <typename V, typename Sum> inline V nextCorners(const V& corners, const Sum* more)
{
#if CV_SIMD_WIDTH == 64
    // v_rotate_right makes a slower instruction of this
    const int words = GROUP_CHANNELS * (int)sizeof(Sum) / 8;
    return V(_mm512_alignr_epi64(_mm512_castsi128_si512(loadCorner(more).val), corners.val, words));
#else
    return v_rotate_right<GROUP_CHANNELS>(corners, V(_mm256_castsi128_si256(loadCorner(more).val)));
#endif
}
#endif

//! From a row of corners: their differences, which are sums over a row of left and of right cells and all above.
template <typename V> struct RowSums
{
    V left, right;

    template <typename Sum> RowSums(const Sum* row, const size_t* offsets)
    {
        const V even = gatherCorners<V>(row, offsets), odd = gatherCorners<V>(row, offsets + 1);
        left = subtract(odd, even);
        right = subtract(nextCorners(even, row + offsets[2 * VTraits<V>::max_nlanes / GROUP_CHANNELS]), odd);
    }
};

//! The row of the ring that ends above row y of the image.
template <typename Sum> class RowFinder
{
public:
    RowFinder(const IntegralRows<Sum>& rows, int top)
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
void cellSums(const IntegralRows<Sum>& rows, const int* xEdges, const int* yEdges, int n, CellGrid<Sum>& cells)
{
    typedef decltype(load((const Sum*)0)) V;
    const int columns = 2 * VTraits<V>::max_nlanes / GROUP_CHANNELS;
    AutoBuffer<size_t, 128> offsets(n + 1 + columns);
    for (int c = 0; c <= n; c++)
        offsets[c] = (size_t)(xEdges[c] - rows.origin.x) * GROUP_CHANNELS;
    for (int c = n + 1; c <= n + columns; c++)  // beyond the last column the last edge is repeated
        offsets[c] = offsets[n];

    cells.create(n);
    const size_t step = cells.rowStep();
    const RowFinder<Sum> row(rows, yEdges[0]);
    for (int c = 0; c < n; c += columns)
    {
        Sum *left = cells.row(0, 0) + c / 2 * GROUP_CHANNELS, *right = cells.row(0, 1) + c / 2 * GROUP_CHANNELS;
        RowSums<V> above(row(yEdges[0]), offsets.data() + c);
        for (int r = 1; r <= n; r++, left += step, right += step)
        {
            const RowSums<V> below(row(yEdges[r]), offsets.data() + c);
            v_store(left, subtract(below.left, above.left));
            v_store(right, subtract(below.right, above.right));
            above = below;
        }
    }
}

}  // namespace

CellEdgesFunc getCellEdgesFunc()
{
    return cellEdges;
}

CellSumsFunc<ushort>::Type getCellSumsFunc(ushort)
{
    return cellSums<ushort>;
}

CellSumsFunc<unsigned>::Type getCellSumsFunc(unsigned)
{
    return cellSums<unsigned>;
}

#endif

CV_CPU_OPTIMIZATION_NAMESPACE_END

}  // namespace iib
}  // namespace cv
