// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#pragma once

#include <numeric>

#include "../../common/aligned_buffer.hpp"
#include "../../common/bit_io.hpp"
#include "opencv2/iib/detail/places.hpp"

namespace cv { namespace iib {

constexpr int MAX_GRANULARITY = 6;

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

/** A quarter of the overlapping quads of a level: those whose top left cells are in rows dy, dy + 2, ... and columns
 dx, dx + 2, ... Their comparisons lie in memory row by row, and in a row plane by plane, of which there is one for
 each bit of the mapping; a plane has GROUP_CHANNELS bits for each quad, and is made of whole chunks. */
struct QuadPhase
{
    int dy, dx, rows, quads;

    static constexpr int COUNT = 4, CHUNK = 16;

    //! @param i 0 to COUNT - 1, which of those on n x n cells; all but the first exist with overlap only.
    QuadPhase(int n, int i) : dy(i / 2), dx(i % 2), rows((n - dy) / 2), quads((n - dx) / 2) {}

    int lanes() const { return quads * GROUP_CHANNELS; }
    int planeBytes() const { return (lanes() + CHUNK - 1) / CHUNK * (CHUNK / 8); }
};

//! The bits of a phase that are in use, all or some (paper, "Reduction of the IIB Descriptor Size"), in their order.
class ChosenBits
{
public:
    //! Some that lie in SIZE bytes of comparisons.
    struct Group
    {
        static constexpr int SIZE = 16;
        size_t byte;         //!< the first of those bytes
        int count;           //!< bits, up to SIZE
        uchar places[SIZE];  //!< bytes of the bits, counted from the first; 128 if there is no bit
        uchar masks[SIZE];   //!< the bits in their bytes; 1 if there is none
    };

    //! @param masks a bit for each comparison of the phase, where the comparison lies in memory.
    explicit ChosenBits(const std::vector<uint64>& masks)
        : whole(std::count(masks.begin(), masks.end(), ~(uint64)0) == (ptrdiff_t)masks.size())
    {
        for (size_t bit = 0; bit < 64 * masks.size(); bit++)
        {
            if (!(masks[bit / 64] >> bit % 64 & 1))
                continue;
            const size_t byte = bit / 8;
            if (none() || chosen.back().count == Group::SIZE || byte - chosen.back().byte >= Group::SIZE)
            {
                Group next = {byte, 0, {}, {}};
                std::fill_n(next.places, (int)Group::SIZE, (uchar)128);
                std::fill_n(next.masks, (int)Group::SIZE, (uchar)1);
                chosen.push_back(next);
            }
            Group& group = chosen.back();
            group.places[group.count] = (uchar)(byte - group.byte);
            group.masks[group.count++] = (uchar)(1 << bit % 8);
        }
    }

    bool none() const { return chosen.empty(); }
    int count() const
    {
        return std::accumulate(chosen.begin(), chosen.end(), 0,
                [](int bits, const Group& group) { return bits + group.count; });
    }
    //! Whether all comparisons are: those in memory are then what the descriptor holds.
    bool all() const { return whole; }
    const std::vector<Group>& groups() const { return chosen; }

private:
    bool whole;
    std::vector<Group> chosen;
};

//! What the parameters say about a level, for one group of channels.
struct LevelShape
{
    int n;                           //!< cells in a row
    int step;                        //!< finest cells in a cell of this level, along an axis
    int offset;                      //!< of its first bit in the descriptor
    std::vector<ChosenBits> chosen;  //!< of each phase
};

//! The cells of a level along one axis: between every `step`-th of the finest cells' edges.
struct Axis
{
    const int* edges;
    int step;

    //! Before cell i.
    int edge(int i) const { return edges[i * step]; }

    int length(int i) const { return edge(i + 1) - edge(i); }
};

/** Factors that make the sums of neighbouring cells along an axis comparable, 1 if they are equally
 long. With widths w0, w1 and heights h0, h1 of a quad's cells, the mean of cell (i, j) is sum / (w_j h_i), and
 sum * w_(1-j) * h_(1-i) is that but for a factor common to the four: decisions need no division. */
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
