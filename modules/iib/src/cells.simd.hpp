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

inline v_uint16 load(const ushort* p) { return vx_load(p); }
inline v_uint32 load(const unsigned* p) { return vx_load(p); }

// Differences modulo 2^16 or 2^32, as the sums.
inline v_uint16 subtract(const v_uint16& a, const v_uint16& b) { return v_sub_wrap(a, b); }
inline v_uint32 subtract(const v_uint32& a, const v_uint32& b) { return a - b; }

inline void storeWide(int* out, const v_uint16& v)
{
    v_uint32 low, high;
    v_expand(v, low, high);
    v_store(out, v_reinterpret_as_s32(low));
    v_store(out + v_uint32::nlanes, v_reinterpret_as_s32(high));
}

inline void storeWide(int* out, const v_uint32& v)
{
    v_store(out, v_reinterpret_as_s32(v));
}

/* The corners are brought together first, those of even and of odd columns apart, so that all further work is on
 whole vectors. */
template <typename Sum>
void cellSums(const IntegralRows<Sum>& rows, const int* xEdges, const int* yEdges, int n, CellGrid<Sum>& corners,
              CellGrid<int>& cells)
{
    corners.create(n);
    cells.create(n);
    AutoBuffer<int, 65> offsets(n + 1);
    for (int c = 0; c <= n; c++)
        offsets[c] = (xEdges[c] - rows.origin.x) * GROUP_CHANNELS;
    const int first = (yEdges[0] - rows.origin.y) % rows.count;
    for (int r = 0; r <= n; r++)
    {
        const int place = first + yEdges[r] - yEdges[0];
        const Sum* from = rows.data + (place < rows.count ? place : place - rows.count) * rows.step;
        Sum *even = corners.row(r, 0), *odd = corners.row(r, 1);
        for (int c = 0; c < n; c += 2)
        {
            memcpy(even + c / 2 * GROUP_CHANNELS, from + offsets[c], GROUP_CHANNELS * sizeof(Sum));
            memcpy(odd + c / 2 * GROUP_CHANNELS, from + offsets[c + 1], GROUP_CHANNELS * sizeof(Sum));
        }
        memcpy(even + n / 2 * GROUP_CHANNELS, from + offsets[n], GROUP_CHANNELS * sizeof(Sum));
    }

    for (int r = 0; r < n; r++)
    {
        const Sum *even0 = corners.row(r, 0), *even1 = corners.row(r + 1, 0);
        const Sum *odd0 = corners.row(r, 1), *odd1 = corners.row(r + 1, 1);
        int *left = cells.row(r, 0), *right = cells.row(r, 1);
        for (int i = 0; i < n / 2 * GROUP_CHANNELS; i += CV_SIMD_WIDTH / (int)sizeof(Sum))
        {
            const int next = i + GROUP_CHANNELS;
            const auto middle = subtract(load(odd1 + i), load(odd0 + i));
            storeWide(left + i, subtract(middle, subtract(load(even1 + i), load(even0 + i))));
            storeWide(right + i, subtract(subtract(load(even1 + next), load(even0 + next)), middle));
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
