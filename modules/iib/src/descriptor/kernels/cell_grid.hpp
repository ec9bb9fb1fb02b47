// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#ifndef OPENCV_IIB_DESCRIPTOR_KERNELS_CELL_GRID_HPP
#define OPENCV_IIB_DESCRIPTOR_KERNELS_CELL_GRID_HPP

#include "../../common/aligned_buffer.hpp"

namespace cv {
namespace iib {

constexpr int MAX_GRANULARITY = 6;
constexpr int GROUP_CHANNELS = 4;  //!< channels that integral images and kernels carry side by side

/** Sums over the cells of one level, n x n cells of GROUP_CHANNELS channels each. The cells in even columns of a
 row lie side by side, and those in odd columns: the left and right cells of the quads. T is ushort or unsigned, as
 the sums in integral images, or double where an unsigned is too small. */
template <typename T> class CellGrid
{
public:
    CellGrid() : n(0), step(0) {}

    void create(int cellsInRow)
    {
        n = cellsInRow;
        step = wholeLines<T>((size_t)n / 2 * GROUP_CHANNELS + CACHE_LINE / sizeof(T));
        values.allocate(2 * (n + 1) * step);  // a row more, for the corners of cells
    }

    //! Cells (row, parity), (row, parity + 2), ... Kernels may read and write a vector past the end.
    T* row(int r, int parity) { return values.data() + (2 * r + parity) * step; }
    const T* row(int r, int parity) const { return values.data() + (2 * r + parity) * step; }

    //! The channels of one cell.
    const T* cell(int r, int c) const { return row(r, c & 1) + (c >> 1) * GROUP_CHANNELS; }
    T* cell(int r, int c) { return row(r, c & 1) + (c >> 1) * GROUP_CHANNELS; }

    int size() const { return n; }

    //! Values from a row to the next one.
    size_t rowStep() const { return 2 * step; }

private:
    int n;
    size_t step;
    AlignedBuffer<T> values;
};

//! The edge of pixels nearest to a position, in [first, limit]: on positive numbers the cast is a floor.
static inline int edgeAt(double position, int first, int limit)
{
    return (int)(std::min(std::max(position + 0.5, (double)first), (double)limit) - first) + first;
}

//! The n + 1 edges of n columns, and copies of the last one: kernels read up to 7 more columns of any level.
constexpr int paddedEdges(int n) { return n + 1 + 7 * (n / 2); }

//! The edges of the finest cells of a support region, in pixels or samples.
struct CellEdges
{
    int x[paddedEdges(1 << MAX_GRANULARITY)];  //!< paddedEdges(n) of them are in use
    int y[(1 << MAX_GRANULARITY) + 1];
};

}  // namespace iib
}  // namespace cv

#endif
