// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#ifndef OPENCV_IIB_BITS_HPP
#define OPENCV_IIB_BITS_HPP

#include "cell_grid.hpp"
#include "../selection.hpp"

namespace cv {
namespace iib {

//! The cells of a level along one axis: between every `step`-th of the finest cells' edges.
struct Axis
{
    const int* edges;
    int step;

    //! Before cell i.
    int edge(int i) const { return edges[i * step]; }

    int length(int i) const { return edge(i + 1) - edge(i); }
};

/** What makes the sums of a level comparable. With widths w0, w1 and heights h0, h1 of a quad's cells, the
 mean of cell (i, j) is sum / (w_j h_i), and sum * w_(1-j) * h_(1-i) is that but for a factor common to the
 four: decisions need no division. */
struct LevelShape
{
    int n;       //!< cells in a row
    int offset;  //!< of its first bit in the descriptor
    Axis x, y;
    int channels;              //!< of GROUP_CHANNELS, those in use
    int windows;               //!< a bit for each that is in use
    const ChosenBits* chosen;  //!< of each phase, or null: the bits of all quads are in use

    bool uses(int phase) const { return windows >> phase & 1; }
};

//! The factors of neighbouring cells along an axis, 1 if they are equally long.
struct Weights
{
    int first, second;

    //! @param a, b lengths of the first and second cell.
    CV_ALWAYS_INLINE Weights(int a, int b) : first(a == b ? 1 : b), second(a == b ? 1 : a) {}
    //! Of cells i and i + 1.
    CV_ALWAYS_INLINE Weights(const Axis& axis, int i) : Weights(axis.length(i), axis.length(i + 1)) {}

    bool equal() const { return first == second; }
};

/* Kernels on the sums of a level, Cell = ushort or unsigned. */
template <typename Cell> struct BitsKernels
{
    /** Bits of the levels from `finest` down to `coarsest`, in the order of descriptor.hpp.
     @param cells of the finest one. @param shapes of each level.
     @param sums of each level: gets those of the coarser ones, down to coarsest - 1. Their grids have been created. */
    void (*levelBits)(const CellGrid<Cell>& cells, const LevelShape shapes[], int finest, int coarsest,
            CellGrid<unsigned> sums[], uchar* descriptor);

    //! The sums alone.
    void (*parentSums)(const CellGrid<Cell>& cells, CellGrid<unsigned>& parents);

    const char* instructionSet;  //!< for which they were compiled
};
CV_EXPORTS BitsKernels<ushort> getBitsKernels(int mapping, ushort);
BitsKernels<unsigned> getBitsKernels(int mapping, unsigned);

//! The bits where an int is too small for the products.
void wideLevelBits(int mapping, const CellGrid<double>& cells, const LevelShape& shape, BitWriter& out);

}  // namespace iib
}  // namespace cv

#endif
