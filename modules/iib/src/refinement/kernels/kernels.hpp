// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#pragma once

#include "../../precomp.hpp"

namespace cv { namespace iib {

/* A patch is PATCH x PATCH samples, 2 units apart, of a smoothed image. All sums are exact integers. */
constexpr int PATCH = 16, PATCH_SAMPLES = PATCH * PATCH;
constexpr int TEMPLATE = 2 * PATCH + 1;  //!< side of the pixels that a patch is sampled from
constexpr int WINDOW_BITS = 6, WINDOW = 1 << WINDOW_BITS;  //!< largest side of the pixels around a point
constexpr int WINDOW_STEP = 2 * WINDOW;                    //!< pixels from a row of a window to the next
constexpr int IMAGE_BORDER = WINDOW / 2 + 1;               //!< pixels that windows reach beyond an image
constexpr int POSITION_BITS = 16;                          //!< unit of positions: 2^-16 pixels
constexpr int SAMPLE_BITS = 5;                             //!< unit of samples: 2^-5 grey levels, -128..127
constexpr int WEIGHT_BITS = 11;                            //!< of the sum of samples
constexpr int GAIN_BITS = 8;  //!< gains are below 256, samples below 2^12: products fit 32 bits

//! x, y, and four of a linear warp: derivatives by x and y, each times the sample's x and y.
constexpr int PARAMETERS = 6;

//! Weighted sums over samples: of the samples, their squares, and their products with the template and its derivatives.
enum
{
    SUM_SAMPLES,
    SUM_SQUARES,
    SUM_TEMPLATE,
    SUM_DERIVATIVES,
    SUMS = SUM_DERIVATIVES + PARAMETERS
};

//! Positions of a patch's samples in a window: that of the first one, and the steps to the next column and row.
struct PatchGrid
{
    Point first, column, row;
};

//! A Gaussian around the centre, its products with x and y, and x and y in 16 units. All are fractions of 2^15.
struct PatchWeights
{
    short gaussian[PATCH_SAMPLES], gaussianX[PATCH_SAMPLES], gaussianY[PATCH_SAMPLES];
    short x[PATCH_SAMPLES], y[PATCH_SAMPLES];
};

struct PatchTemplate
{
    short samples[PATCH_SAMPLES];
    short derivatives[PARAMETERS][PATCH_SAMPLES];       //!< the four of the linear warp are halved
    short weights[SUMS - SUM_TEMPLATE][PATCH_SAMPLES];  //!< half the weights of SUM_TEMPLATE and after
};

/* Sums of products of values with themselves, with their right neighbours, and with the values below, without the last
 row. Pairs from the end of a row to the begin of the next are included: weights are small there. */
struct Autocorrelation
{
    int squares, right, below;
};

//! The coarse comparison takes COARSE_PIXELS x COARSE_PIXELS pixels of each image, COARSE_STEP pixels apart in the first.
constexpr int COARSE_PIXELS = 8, COARSE_STEP = 4;

//! Weighted sums over pixels less 128; the weights add up to WEIGHTS.
struct CoarseSums
{
    static constexpr int WEIGHTS = 400;
    int first, second, firstSquares, secondSquares, products;
};

//! Sums over squared first and second differences of neighbouring pixels.
struct SquaredDifferences
{
    int first, second;
};

struct RefinementKernels
{
    //! (1 2 1) / 4 in both directions; rows are continued by their last pixels. `sums` holds width + 2 values.
    void (*smooth)(const uchar* const rows[3], ushort* sums, uchar* out, int width);
    /** Writes two bytes for each pixel of `size` and of one column more: its value and that of the pixel below, each
     less 128. Two neighbours then hold the four pixels around a sample. Reads one row more than `size` has, and
     WINDOW + 1 pixels of each row. */
    void (*readWindow)(const uchar* pixels, size_t step, Size size, ushort* window);
    //! Bilinear samples of a window; all must be inside.
    void (*sample)(const ushort* window, const PatchGrid& grid, short* samples);
    /** Sums of the coarse comparison. Reads three bytes beyond each pixel.
    @param rows positions of the first pixel of each row in the second image
    @param column step to the next pixel of a row; positions and step in 2^-POSITION_BITS pixels */
    CoarseSums (*coarseSums)(const uchar* pixels1, size_t step1, const uchar* pixels2, size_t step2,
            const Point (&rows)[COARSE_PIXELS], const Point& column);
    //! Over every fourth row of TEMPLATE x TEMPLATE pixels. @param next offset of a pixel's neighbour.
    SquaredDifferences (*squareDifferences)(const uchar* pixels, size_t step, ptrdiff_t next);
    //! Samples TEMPLATE x TEMPLATE pixels.
    void (*makeTemplate)(const uchar* pixels, size_t step, const PatchWeights& weights, PatchTemplate& out);
    //! All SUMS of the samples.
    void (*sum)(const short* samples, const PatchWeights& weights, const PatchTemplate& patch, int* sums);
    //! sums[i][j], j <= i: weighted derivative i times derivative j.
    void (*sumProducts)(const PatchTemplate& patch, int (*sums)[PARAMETERS]);
    //! (samples - gain * template - offset) times half the weights; gain and offset in 2^-GAIN_BITS.
    void (*subtract)(const short* samples, const PatchWeights& weights, const PatchTemplate& patch, int gain,
            int offset, short* residuals);
    Autocorrelation (*autocorrelate)(const short* values);
};

//! The kernels for this machine.
const RefinementKernels& refinementKernels();

}}  // namespace cv::iib
