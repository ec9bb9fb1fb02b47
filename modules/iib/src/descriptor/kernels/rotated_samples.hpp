// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#pragma once

#include "quads.hpp"

namespace cv {
namespace iib {

/** The nearest pixels to a square grid of points, rotated by an angle. Grid point (row, col) of n x n is at
 (x, y) + (u stepX - v stepY, u stepY + v stepX) / 2 with u = 2 col + 1 - n and v = 2 row + 1 - n. */
struct SampleGrid
{
    int n;             //!< points in a row
    int sub;           //!< a cell has sub x sub points
    int x, y;          //!< pixel that holds the centre
    int fracX, fracY;  //!< the centre's place in it, in 2^-17 pixels
    int stepX, stepY;  //!< from point to point along a row, in 2^-16 pixels
    Size image;        //!< points beyond it get the nearest pixel of its border,
    bool reflect;      //!< or the one that BORDER_REFLECT_101 brings there

    //! Cells in a row.
    int cells() const { return n / sub; }
};

constexpr int MAX_SAMPLES_IN_ROW = 64;  //!< of a grid
constexpr int MAX_SAMPLES = MAX_SAMPLES_IN_ROW * MAX_SAMPLES_IN_ROW;
constexpr int IMAGE_PLANES = 6;  //!< the kinds of channels that an image has, in the order of IIB::Channel

//! An angle, in 2^-12, and in ORIENTATION_STEPS a turn.
struct GradientRotation
{
    int cosine, sine, steps;
};

/* Points are ordered for sums over cells: first by the place within the cell, then by the cell's row, the parity of its
 column, and the column, as in a CellGrid. Sums are in planes, with cells in the same order. */
template <typename T> struct RotatedSampleKernels
{
    //! The places of the pixels nearest to the points among those of `rows`, which hold them all. @param oldest row at hand.
    void (*indices)(const SampleGrid& grid, const RingRows<T>& rows, int oldest, int* index);

    /** Rotates gradients: x' = c x + s y, y' = c y - s x, rounded. The orientation becomes (steps + its own) modulo
     ORIENTATION_STEPS, but 0 where there is no gradient, as upright.
     @param pixels gx, gy, orientation and intensity of each pixel.
     @param sums for each kind of channel; signed gradients without an offset. */
    void (*imageSums)(const T* pixels, const int* index, int cells, int samplesInCell,
            const GradientRotation& rotation, int* const sums[IMAGE_PLANES]);

    //! Magnitudes of gradients times weights, rounded. Arrays have ROW_PADDING values more than `count`.
    void (*gradientVotes)(const int* gx, const int* gy, const int* weights, int count, int* votes);

    //! Sums of four maps as they are.
    void (*mapSums)(
            const T* pixels, const int* index, int cells, int samplesInCell, int* const sums[GROUP_CHANNELS]);

    //! Four planes as a grid of cells, each with a number added.
    void (*interleave)(const int* const sums[GROUP_CHANNELS], const int addends[GROUP_CHANNELS], int cells,
            CellGrid<unsigned>& grid);

    //! Four planes of pixels side by side. They have ROW_PADDING values more than `width`.
    void (*interleaveRow)(const T* const planes[GROUP_CHANNELS], T* out, int width);
};

}  // namespace iib
}  // namespace cv
