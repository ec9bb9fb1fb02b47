// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#pragma once

#include "../../precomp.hpp"

namespace cv {
namespace iib {

/* A patch is PATCH x PATCH samples, 2 units apart: images are smoothed so that nothing is lost between them. All is exact on
 integers. */
constexpr int PATCH = 16, PATCH_SAMPLES = PATCH * PATCH;
constexpr int TEMPLATE = 2 * PATCH + 1;  //!< pixels in rows and columns: samples and their neighbours
constexpr int WINDOW_BITS = 6, WINDOW = 1 << WINDOW_BITS;  //!< most pixels in rows and columns around a point
constexpr int WINDOW_PADDING = 64;
constexpr int POSITION_BITS = 16;  //!< positions in a window are pixels in 2^-16
constexpr int SAMPLE_BITS = 5;     //!< samples are normalized grey levels of -128..127 in 2^-5
constexpr int WEIGHT_BITS = 11;    //!< of the sum of samples

//! Derivatives of samples by the six parameters: x, y, and the four of a linear map, d/dx and d/dy times places x and y.
constexpr int PARAMETERS = 6;

//! What is summed over samples, each times a weight: its own, itself, the template's, and that of each derivative.
enum
{
    SUM_SAMPLES,
    SUM_SQUARES,
    SUM_TEMPLATE,
    SUM_DERIVATIVES,
    SUMS = SUM_DERIVATIVES + PARAMETERS
};

//! Where the samples of a patch are in a window: the first, and what a column and a row add.
struct PatchGrid
{
    Point first, column, row;
};

//! A Gaussian around the centre, at most 1, itself and times x and y; and x and y, in 16 units. All in 2^-15.
struct PatchWeights
{
    short gaussian[PATCH_SAMPLES], gaussianX[PATCH_SAMPLES], gaussianY[PATCH_SAMPLES];
    short x[PATCH_SAMPLES], y[PATCH_SAMPLES];
};

struct PatchTemplate
{
    short samples[PATCH_SAMPLES];
    short derivatives[PARAMETERS][PATCH_SAMPLES];       //!< those by the linear map are halved
    short weights[SUMS - SUM_TEMPLATE][PATCH_SAMPLES];  //!< of SUM_TEMPLATE and after, halved
};

struct RefinementKernels
{
    //! (1 2 1) / 4 in both directions; the ends of rows are repeated. `sums` has room for 2 more than `width`.
    void (*smooth)(const uchar* const rows[3], ushort* sums, uchar* out, int width);
    /** A row of a window: four bytes of the image a pixel, each less 128: its own, the one below, the one to the right, the
     one below that. Reads WINDOW_PADDING pixels more than `width`, and writes full vectors. */
    void (*readWindow)(const uchar* upper, const uchar* lower, int* out, int width);
    //! Samples of a window, bilinear; all must be inside.
    void (*sample)(const int* window, const PatchGrid& grid, short* samples);
    //! Samples of TEMPLATE x TEMPLATE pixels, their derivatives, and these times weights.
    void (*makeTemplate)(const uchar* pixels, const PatchWeights& weights, PatchTemplate& out);
    //! The sums of samples.
    void (*sum)(const short* samples, const PatchWeights& weights, const PatchTemplate& patch, int* sums);
    //! The sums of weighted derivatives times derivatives, j <= i, in rows.
    void (*sumProducts)(const PatchTemplate& patch, int (*sums)[PARAMETERS]);
};

//! The kernels for this machine.
const RefinementKernels& refinementKernels();

}  // namespace iib
}  // namespace cv
