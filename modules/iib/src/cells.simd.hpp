// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "intrinsics.hpp"

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

//! Two corners that are neighbours in a row of the grid; few wide stores, since all are read again as vectors.
inline void copyPair(const ushort* a, const ushort* b, ushort* out)
{
    v_store(out, v_load_halves(a, b));
}

inline void copyPair(const unsigned* a, const unsigned* b, unsigned* out)
{
    v_store(out, v_load(a));
    v_store(out + GROUP_CHANNELS, v_load(b));
}

inline void storeWide(int* out, const v_uint16& v)
{
    v_uint32 low, high;
    v_expand(v, low, high);
    v_store(out, v_reinterpret_as_s32(low));
    v_store(out + VTraits<v_uint32>::max_nlanes, v_reinterpret_as_s32(high));
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
    AutoBuffer<int, 68> offsets(n + 4);
    for (int c = 0; c < n + 4; c++)
        offsets[c] = (xEdges[std::min(c, n)] - rows.origin.x) * GROUP_CHANNELS;
    const int first = (yEdges[0] - rows.origin.y) % rows.count;
    for (int r = 0; r <= n; r++)
    {
        const int place = first + yEdges[r] - yEdges[0];
        const Sum* from = rows.data + (place < rows.count ? place : place - rows.count) * rows.step;
        Sum *even = corners.row(r, 0), *odd = corners.row(r, 1);
        for (int c = 0; c < n; c += 4)  // beyond the last column the offsets repeat
        {
            copyPair(from + offsets[c], from + offsets[c + 2], even + c / 2 * GROUP_CHANNELS);
            copyPair(from + offsets[c + 1], from + offsets[c + 3], odd + c / 2 * GROUP_CHANNELS);
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
    const int n = children.size() / 2, lanes = VTraits<v_int32>::max_nlanes;
    cells.create(n);
    const size_t parity = children.row(0, 1) - children.row(0, 0), row = children.row(1, 0) - children.row(0, 0);
    const int* in = children.row(0, 0);
    for (int r = 0; r < n; r++, in += 2 * row)
    {
        int *even = cells.row(r, 0), *odd = cells.row(r, 1);
        for (int i = 0; i < n * GROUP_CHANNELS; i += 2 * lanes)
        {
            v_int32 sums[2];
            for (int j = 0; j < 2; j++)
            {
                const int* p = in + i + j * lanes;
                sums[j] = (vx_load(p) + vx_load(p + parity)) + (vx_load(p + row) + vx_load(p + row + parity));
            }
            v_int32 evens, odds;
            splitColumns(sums[0], sums[1], evens, odds);
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
