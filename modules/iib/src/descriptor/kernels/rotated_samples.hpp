// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#ifndef OPENCV_IIB_ROTATED_SAMPLES_HPP
#define OPENCV_IIB_ROTATED_SAMPLES_HPP

#include "cell_grid.hpp"

namespace cv {
namespace iib {

/** The nearest pixels to a square grid of points, turned by an angle. Grid point (row, col) of n x n is at
 (x, y) + (u stepX - v stepY, u stepY + v stepX) / 2 with u = 2 col + 1 - n and v = 2 row + 1 - n. */
struct SampleGrid
{
    int n;             //!< points in a row
    int x, y;          //!< pixel that holds the centre
    int fracX, fracY;  //!< the centre's place in it, in 2^-17 pixels
    int stepX, stepY;  //!< from point to point along a row, in 2^-16 pixels
    Size image;        //!< pixels beyond it repeat its border
    Rect area;         //!< the pixels at hand
};

/* Points are ordered for sums over cells of `sub` x `sub` points: first by the place within the cell, then by the
 cell's row, the parity of its column, and the column, as in a CellGrid. */
template <typename T> struct RotatedSampleKernels
{
    //! The indices in `area`, row by row, of the grid's n * n points.
    void (*indices)(const SampleGrid& grid, int sub, int* index);
    //! Reads pixels of GROUP_CHANNELS values into as many planes.
    void (*gather)(const T* pixels, const int* index, int count, T* const planes[GROUP_CHANNELS]);
    //! Turns gradients by an angle given in 2^-12: x' = c x + s y, y' = c y - s x, rounded.
    void (*rotate)(T* gx, T* gy, int count, int cosine, int sine);
    //! steps = (steps + turn) modulo ORIENTATION_STEPS, but 0 where there is no gradient, as upright.
    void (*turn)(const T* gx, const T* gy, T* steps, int count, int turn);
    //! Sums over cells; n / sub cells in a row.
    void (*sum)(const T* const planes[GROUP_CHANNELS], int n, int sub, CellGrid<unsigned>& cells);
};

const RotatedSampleKernels<short>& shortRotatedSampleKernels();
const RotatedSampleKernels<int>& intRotatedSampleKernels();

}  // namespace iib
}  // namespace cv

#endif
