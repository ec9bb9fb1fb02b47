// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#pragma once

#include "../../precomp.hpp"

namespace cv {
namespace iib {

/* Patches are rows of columns around a point; neighbours are one unit apart. All is exact on integers, or on floats in one
 order of operations. */
constexpr int PATCH_COLUMNS = 32, PATCH_ROWS = 28, PATCH_SAMPLES = PATCH_COLUMNS * PATCH_ROWS;
constexpr int WINDOW_BITS = 6, WINDOW = 1 << WINDOW_BITS;  //!< most pixels in rows and columns around a point
constexpr int WINDOW_PADDING = 64;
constexpr int POSITION_BITS = 16;  //!< positions in a window are pixels in 2^-16
constexpr int SAMPLE_BITS = 6;     //!< samples are normalized grey levels of -128..127 in 2^-6

/* What is summed over the samples of a patch, each times a weight: its own, that times the template, and that times the
 template's derivatives by six parameters, x, y, and the four of a linear map. */
enum
{
    SUM_SAMPLES,
    SUM_TEMPLATE,
    SUM_DERIVATIVES,
    SUMS = SUM_DERIVATIVES + 6
};

/* What is summed over each column of a template: products of two derivatives, by x and by y, and these themselves; times
 powers of y. */
enum
{
    COLUMN_XX,
    COLUMN_XY = COLUMN_XX + 3,
    COLUMN_YY = COLUMN_XY + 3,
    COLUMN_X = COLUMN_YY + 3,
    COLUMN_Y = COLUMN_X + 2,
    COLUMN_SUMS = COLUMN_Y + 2
};

//! Where the samples of a patch are in a window: the first, and what a column and a row add.
struct PatchGrid
{
    Point first, column, row;
};

//! A Gaussian around the patch's centre.
struct PatchWeights
{
    float columns[PATCH_COLUMNS], rows[PATCH_ROWS];  //!< the sum of all products is 1
    float x[PATCH_COLUMNS], y[PATCH_ROWS];           //!< places, in 16 units
    short samples[PATCH_SAMPLES];                    //!< products of the above, times a factor
    short roots[PATCH_SAMPLES];                      //!< square roots of products, times another
};

struct RefinementKernels
{
    //! (1 2 1) / 4 in both directions; the ends of rows are repeated.
    void (*smooth)(const uchar* const rows[3], uchar* out, int width);
    /** A row of a window: four bytes of the image a pixel, each less 128: its own, the one below, the one to the right, the
     one below that. Reads WINDOW_PADDING pixels more than `width`, and writes full vectors. */
    void (*readWindow)(const uchar* upper, const uchar* lower, int* out, int width);
    //! Samples of a window, bilinear, of each rowStep-th row; all must be inside.
    void (*sample)(const int* window, const PatchGrid& grid, int rowStep, short* samples);
    /** sums[k] of the samples of each rowStep-th row times weights[k]; and returns the sum of their squares, times weights in
     2^-32. */
    int (*sum)(const short* samples, const short* const* weights, const short* roots, int rowStep, int* sums);
    //! Differences of the samples on both sides; at an end, one of these is the sample itself.
    void (*derive)(const short* samples, short* x, short* y);
    //! Sums of columns of products of derivatives.
    void (*sumColumns)(
            const short* x, const short* y, const PatchWeights& weights, float (*sums)[PATCH_COLUMNS]);
    //! The weights of SUM_TEMPLATE and after, each times a scale.
    void (*weigh)(const short* samples, const short* x, const short* y, const PatchWeights& weights,
            float mean, const float* scales, short* const* out);
};

//! The kernels for this machine.
const RefinementKernels& refinementKernels();

}  // namespace iib
}  // namespace cv
