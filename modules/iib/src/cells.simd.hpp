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
    for (int c = 0; c <= n; c++)
    {
        const size_t x = (size_t)(xEdges[c] - rows.origin.x) * GROUP_CHANNELS;
        v_int32x4 above = loadCorner(corners[0] + x);
        for (int r = 0; r < n; r++)
        {
            const v_int32x4 below = loadCorner(corners[r + 1] + x);
            v_store(columns.cell(r, c), below - above);
            above = below;
        }
    }

    cells.create(n);
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

void parentSums(const CellGrid<int>& children, CellGrid<int>& cells)
{
    const int n = children.size() / 2;
    cells.create(n);
    AutoBuffer<int, 256> line(n * GROUP_CHANNELS + ROW_PADDING);
    for (int r = 0; r < n; r++)
    {
        const int *topLeft = children.row(2 * r, 0), *topRight = children.row(2 * r, 1);
        const int *bottomLeft = children.row(2 * r + 1, 0), *bottomRight = children.row(2 * r + 1, 1);
        for (int i = 0; i < n * GROUP_CHANNELS; i += v_int32::nlanes)
            v_store(line.data() + i, (vx_load(topLeft + i) + vx_load(topRight + i))
                                         + (vx_load(bottomLeft + i) + vx_load(bottomRight + i)));
        for (int c = 0; c < n; c++)
            v_store(cells.cell(r, c), v_load(line.data() + c * GROUP_CHANNELS));
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
