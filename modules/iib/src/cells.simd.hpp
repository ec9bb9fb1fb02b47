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

//! Brings ROWS rows of corners together; several at a time, since their offsets are the same.
template <int ROWS, typename Sum>
inline void gatherCorners(const Sum* const from[ROWS], const int* offsets, int n, Sum* even, Sum* odd, size_t step)
{
    for (int c = 0; c < n; c += 4)  // beyond the last column the offsets repeat
    {
        const int o0 = offsets[c], o1 = offsets[c + 1], o2 = offsets[c + 2], o3 = offsets[c + 3];
        const int at = c / 2 * GROUP_CHANNELS;
        for (int i = 0; i < ROWS; i++)
        {
            copyPair(from[i] + o0, from[i] + o2, even + i * step + at);
            copyPair(from[i] + o1, from[i] + o3, odd + i * step + at);
        }
    }
    for (int i = 0; i < ROWS; i++)
        memcpy(even + i * step + n / 2 * GROUP_CHANNELS, from[i] + offsets[n], GROUP_CHANNELS * sizeof(Sum));
}

//! Cells from their corners, a vector of columns after the other.
template <typename Sum> void subtractCorners(const CellGrid<Sum>& corners, CellGrid<Sum>& cells)
{
    const int n = cells.size(), lanes = CV_SIMD_WIDTH / (int)sizeof(Sum);
    const size_t step = corners.rowStep();
    for (int i = 0; i < n / 2 * GROUP_CHANNELS; i += lanes)
    {
        // Differences along row 0 of corners, then those along each next row less those before.
        const Sum *evens = corners.row(0, 0) + i, *odds = corners.row(0, 1) + i;
        Sum *lefts = cells.row(0, 0) + i, *rights = cells.row(0, 1) + i;
        auto odd = load(odds), left = subtract(odd, load(evens)), right = subtract(load(evens + GROUP_CHANNELS), odd);
        for (int r = 0; r < n; r++, lefts += step, rights += step)
        {
            evens += step;
            odds += step;
            odd = load(odds);
            const auto nextLeft = subtract(odd, load(evens)), nextRight = subtract(load(evens + GROUP_CHANNELS), odd);
            v_store(lefts, subtract(nextLeft, left));
            v_store(rights, subtract(nextRight, right));
            left = nextLeft;
            right = nextRight;
        }
    }
}

/* The corners are brought together first, those of even and of odd columns apart, so that all further work is on
 whole vectors. */
template <typename Sum>
void cellSums(const IntegralRows<Sum>& rows, const int* xEdges, const int* yEdges, int n, CellGrid<Sum>& corners,
              CellGrid<Sum>& cells)
{
    corners.create(n);
    cells.create(n);
    AutoBuffer<int, 68> offsets(n + 4);
    for (int c = 0; c <= n; c++)
        offsets[c] = (xEdges[c] - rows.origin.x) * GROUP_CHANNELS;
    for (int c = n + 1; c < n + 4; c++)
        offsets[c] = offsets[n];
    const int first = (yEdges[0] - rows.origin.y) % rows.count - yEdges[0], count = rows.count;
    const Sum* const data = rows.data;
    const size_t rowStep = rows.step;
    const auto row = [=](int r)
    {
        const int place = first + yEdges[r];
        return data + (place < count ? place : place - count) * rowStep;
    };
    Sum *even = corners.row(0, 0), *odd = corners.row(0, 1);
    const size_t step = corners.rowStep();
    const Sum* top[1] = { row(0) };
    gatherCorners<1>(top, offsets.data(), n, even, odd, step);
    for (int r = 1; r <= n; r += 2)
    {
        const Sum* from[2] = { row(r), row(r + 1) };
        gatherCorners<2>(from, offsets.data(), n, even + r * step, odd + r * step, step);
    }
    subtractCorners(corners, cells);
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

#endif

CV_CPU_OPTIMIZATION_NAMESPACE_END

}  // namespace iib
}  // namespace cv
