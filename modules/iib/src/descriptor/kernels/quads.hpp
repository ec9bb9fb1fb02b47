// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#pragma once

#include "../../common/aligned_buffer.hpp"
#include "chosen_bits.hpp"
#include "opencv2/iib/detail/places.hpp"

namespace cv { namespace iib {

constexpr int MAX_GRANULARITY = 6;

/** Sums over the n x n cells of a level, with GROUP_CHANNELS channels each. In a row, the cells of even columns come first,
 then those of odd columns: the left and right cells of quads. T is ushort, unsigned or, for larger sums, double. */
template <typename T> class CellGrid
{
public:
    CellGrid() : n(0), step(0) {}

    void create(int cellsInRow)
    {
        n = cellsInRow;
        step = wholeLines<T>((size_t)n / 2 * GROUP_CHANNELS + CACHE_LINE / sizeof(T));
        values.allocate(2 * (n + 1) * step);  // one row more, for the corners of cells
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

//! The pixel edge nearest to a position, in [first, limit]. The cast is a floor for positive numbers.
static inline int edgeAt(double position, int first, int limit)
{
    return (int)(std::min(std::max(position + 0.5, (double)first), (double)limit) - first) + first;
}

//! Number of edges of n columns, padded with copies of the last one: kernels read up to 7 more columns of any level.
constexpr int paddedEdges(int n) { return n + 1 + 7 * (n / 2); }

//! The edges of the finest cells of a support region, in pixels or samples.
struct CellEdges
{
    int x[paddedEdges(1 << MAX_GRANULARITY)];  //!< paddedEdges(n) of them are in use
    int y[(1 << MAX_GRANULARITY) + 1];
};

/** A quarter of the overlapping quads of a level: those whose top left cells are in rows dy, dy + 2, ... and columns
 dx, dx + 2, ... Comparisons are stored row by row, and in a row plane by plane, one for each bit of the mapping. A plane has
 GROUP_CHANNELS bits for each quad, padded to whole chunks. */
struct QuadPhase
{
    int dy, dx, rows, quads;

    static constexpr int COUNT = 4, CHUNK = 16;

    //! @param n cells in a row. @param i number of the phase; without overlap there is only phase 0.
    QuadPhase(int n, int i) : dy(i / 2), dx(i % 2), rows((n - dy) / 2), quads((n - dx) / 2) {}

    int lanes() const { return quads * GROUP_CHANNELS; }
    int planeBytes() const { return (lanes() + CHUNK - 1) / CHUNK * (CHUNK / 8); }
};

//! A level of a group of channels.
struct LevelShape
{
    int n;                           //!< cells in a row
    int step;                        //!< finest cells in a cell of this level, along an axis
    int offset;                      //!< first bit in the descriptor
    std::vector<ChosenBits> chosen;  //!< of each phase
};

//! The cells of a level along one axis: their edges are every `step`-th of the finest cells' edges.
struct Axis
{
    const int* edges;
    int step;

    //! Before cell i.
    int edge(int i) const { return edges[i * step]; }

    int length(int i) const { return edge(i + 1) - edge(i); }
};

/** Factors that make the sums of neighbouring cells along an axis comparable; 1 if they are equally long. With widths w0, w1
 and heights h0, h1 of a quad's cells, the mean of cell (i, j) is sum / (w_j h_i). sum * w_(1-j) * h_(1-i) is proportional to
 it, with the same factor for all four cells, so no division is needed. */
struct Weights
{
    int first, second;

    //! @param a, b lengths of the first and second cell.
    CV_ALWAYS_INLINE Weights(int a, int b) : first(a == b ? 1 : b), second(a == b ? 1 : a) {}
    //! For cells i and i + 1 of an axis.
    CV_ALWAYS_INLINE Weights(const Axis& axis, int i) : Weights(axis.length(i), axis.length(i + 1)) {}

    bool equal() const { return first == second; }
};

}}  // namespace cv::iib
