// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#pragma once

#include "kernels.hpp"
#include "vectors.simd.hpp"

namespace cv { namespace iib {
CV_CPU_OPTIMIZATION_NAMESPACE_BEGIN
namespace {

inline v_groups16 subtractModulo(const v_groups16& a, const v_groups16& b) { return v_sub_wrap(a, b); }
inline v_groups32 subtractModulo(const v_groups32& a, const v_groups32& b) { return a - b; }

// n is a power of two, so that the edges of a level are a subset of those of the next. Compilers vectorize the loop.
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

//! Sums over left and right cells and everything above them: differences of neighbouring corners in a row.
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

#if IIB_SUMS_SEGMENTS
//! Adds a column of pixels to a column of cells.
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
#else
constexpr decltype(DescriptorKernels::columnCells) columnCells = 0;
#endif

}  // namespace
CV_CPU_OPTIMIZATION_NAMESPACE_END
}}  // namespace cv::iib
