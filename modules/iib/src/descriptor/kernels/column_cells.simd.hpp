// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#ifndef OPENCV_IIB_DESCRIPTOR_KERNELS_COLUMN_CELLS_SIMD_HPP
#define OPENCV_IIB_DESCRIPTOR_KERNELS_COLUMN_CELLS_SIMD_HPP

#include "cells.simd.hpp"

namespace cv {
namespace iib {

CV_CPU_OPTIMIZATION_NAMESPACE_BEGIN

#if IIB_SUMS_SEGMENTS

namespace {

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

#endif

CV_CPU_OPTIMIZATION_NAMESPACE_END

}  // namespace iib
}  // namespace cv

#endif
