// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "opencv2/core/hal/intrin.hpp"

#include "cells.hpp"

namespace cv {
namespace iib {

CV_CPU_OPTIMIZATION_NAMESPACE_BEGIN

CellSumsFunc<ushort>::Type getCellSumsFunc(ushort);
CellSumsFunc<unsigned>::Type getCellSumsFunc(unsigned);
ParentSumsFunc getParentSumsFunc();

#ifndef CV_CPU_OPTIMIZATION_DECLARATIONS_ONLY

namespace {

//! All channels of a corner.
inline v_int32x4 loadCorner(const ushort* p) { return v_reinterpret_as_s32(v_load_expand(p)); }
inline v_int32x4 loadCorner(const unsigned* p) { return v_reinterpret_as_s32(v_load(p)); }

//! Undoes the borrow of a difference of sums modulo 2^16.
inline v_int32 modulo(const v_int32& v, ushort) { return v & vx_setall_s32(0xffff); }
inline v_int32 modulo(const v_int32& v, unsigned) { return v; }

template <typename Sum>
void cellSums(const IntegralRows<Sum>& rows, const int* xEdges, const int* yEdges, int n, CellGrid<int>& columns,
              CellGrid<int>& cells)
{
    // Differences down the columns of corners first, so that the corner above stays in a register.
    AutoBuffer<const Sum*, 65> corners(n + 1);
    for (int r = 0; r <= n; r++)
        corners[r] = rows.at(yEdges[r], rows.origin.x);
    columns.create(n);
    cells.create(n);
    const size_t step = columns.rowStep();
    for (int c = 0; c <= n; c++)
    {
        const size_t x = (size_t)(xEdges[c] - rows.origin.x) * GROUP_CHANNELS;
        int* out = columns.cell(0, c);
        v_int32x4 above = loadCorner(corners[0] + x);
        for (int r = 0; r < n; r++, out += step)
        {
            const v_int32x4 below = loadCorner(corners[r + 1] + x);
            v_store(out, below - above);
            above = below;
        }
    }

    for (int r = 0; r < n; r++)
    {
        const int *even = columns.row(r, 0), *odd = columns.row(r, 1);
        int *left = cells.row(r, 0), *right = cells.row(r, 1);
        for (int i = 0; i < n / 2 * GROUP_CHANNELS; i += v_int32::nlanes)
        {
            const v_int32 middle = vx_load(odd + i);
            v_store(left + i, modulo(middle - vx_load(even + i), Sum()));
            v_store(right + i, modulo(vx_load(even + i + GROUP_CHANNELS) - middle, Sum()));
        }
    }
}

//! The four channels of neighbouring cells, in turn to the even and odd columns.
inline void splitColumns(const v_int32& a, const v_int32& b, v_int32& even, v_int32& odd)
{
#if CV_SIMD_WIDTH == 64
    even = v_int32(_mm512_shuffle_i32x4(a.val, b.val, 0x88));
    odd = v_int32(_mm512_shuffle_i32x4(a.val, b.val, 0xdd));
#elif CV_SIMD_WIDTH == 32
    even = v_int32(_mm256_permute2x128_si256(a.val, b.val, 0x20));
    odd = v_int32(_mm256_permute2x128_si256(a.val, b.val, 0x31));
#else
    even = a;
    odd = b;
#endif
}

void parentSums(const CellGrid<int>& children, CellGrid<int>& cells)
{
    const int n = children.size() / 2, lanes = v_int32::nlanes;
    cells.create(n);
    for (int r = 0; r < n; r++)
    {
        const int *topLeft = children.row(2 * r, 0), *topRight = children.row(2 * r, 1);
        const int *bottomLeft = children.row(2 * r + 1, 0), *bottomRight = children.row(2 * r + 1, 1);
        int *even = cells.row(r, 0), *odd = cells.row(r, 1);
        for (int i = 0; i < n * GROUP_CHANNELS; i += 2 * lanes)
        {
            const int j = i + lanes;
            const v_int32 first = (vx_load(topLeft + i) + vx_load(topRight + i))
                                  + (vx_load(bottomLeft + i) + vx_load(bottomRight + i));
            const v_int32 second = (vx_load(topLeft + j) + vx_load(topRight + j))
                                   + (vx_load(bottomLeft + j) + vx_load(bottomRight + j));
            v_int32 evens, odds;
            splitColumns(first, second, evens, odds);
            v_store(even + i / 2, evens);
            v_store(odd + i / 2, odds);
        }
    }
}

}  // namespace

CellSumsFunc<ushort>::Type getCellSumsFunc(ushort)
{
    return cellSums<ushort>;
}

CellSumsFunc<unsigned>::Type getCellSumsFunc(unsigned)
{
    return cellSums<unsigned>;
}

ParentSumsFunc getParentSumsFunc()
{
    return parentSums;
}

#endif

CV_CPU_OPTIMIZATION_NAMESPACE_END

}  // namespace iib
}  // namespace cv
