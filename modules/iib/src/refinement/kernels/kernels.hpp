// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#pragma once

#include "../../precomp.hpp"

namespace cv { namespace iib {

/* A patch is PATCH x PATCH samples, 2 units apart: images are smoothed so that nothing is lost between them. All is
 exact on integers. */
constexpr int PATCH = 16, PATCH_SAMPLES = PATCH * PATCH;
constexpr int TEMPLATE = 2 * PATCH + 1;  //!< pixels in rows and columns: samples and their neighbours
constexpr int WINDOW_BITS = 6, WINDOW = 1 << WINDOW_BITS;  //!< most pixels in rows and columns around a point
constexpr int WINDOW_STEP = 2 * WINDOW;                    //!< from a row of a window to the next, in pixels
constexpr int IMAGE_BORDER = WINDOW / 2 + 1;               //!< pixels that windows reach beyond an image
constexpr int POSITION_BITS = 16;                          //!< positions in a window are pixels in 2^-16
constexpr int SAMPLE_BITS = 5;   //!< samples are normalized grey levels of -128..127 in 2^-5
constexpr int WEIGHT_BITS = 11;  //!< of the sum of samples
constexpr int GAIN_BITS = 8;     //!< gains are below 256, samples 2^12: products fit 32 bits

//! Derivatives of samples by the six parameters: x, y, and the four of a linear warp, d/dx and d/dy times places x and
//! y.
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
    short derivatives[PARAMETERS][PATCH_SAMPLES];       //!< those by the linear warp are halved
    short weights[SUMS - SUM_TEMPLATE][PATCH_SAMPLES];  //!< of SUM_TEMPLATE and after, halved
};

/* Sums of products of values with themselves, with their right neighbours, and with those below. Neighbours of the last
 row are left out, and the few that are at both ends of two rows count little, as the values have a patch's weights. */
struct Autocorrelation
{
    int squares, right, below;
};

//! A coarse look takes LOOK x LOOK pixels of the first image, so many pixels apart.
constexpr int LOOK = 8, LOOK_APART = 4;

//! Of a look's pixels less 128, each times a weight, which add up to WEIGHTS.
struct LookSums
{
    static constexpr int WEIGHTS = 400;
    int first, second, firstSquares, secondSquares, products;
};

//! Of differences of neighbouring pixels, and of these differences' differences.
struct SquaredDifferences
{
    int first, second;
};

struct RefinementKernels
{
    //! (1 2 1) / 4 in both directions; the ends of rows are repeated. `sums` has room for 2 more than `width`.
    void (*smooth)(const uchar* const rows[3], ushort* sums, uchar* out, int width);
    /** Writes of each pixel of `size`, and of a column more, two bytes: its own value and that of the pixel below, each
     less 128. So two neighbours are the four pixels around a sample. Reads a row more than `size` has, and
     WINDOW + 1 pixels of each row. */
    void (*readWindow)(const uchar* pixels, size_t step, Size size, ushort* window);
    //! Samples of a window, bilinear; all must be inside.
    void (*sample)(const ushort* window, const PatchGrid& grid, short* samples);
    /** A coarse look. Reads three bytes more behind each pixel.
    @param rows of the second image: where the first pixel of each is, and what a column adds, in 2^-POSITION_BITS */
    LookSums (*look)(const uchar* pixels1, size_t step1, const uchar* pixels2, size_t step2,
            const Point (&rows)[LOOK], const Point& column);
    //! Of every fourth row of TEMPLATE x TEMPLATE pixels. @param next from a pixel to its neighbour.
    SquaredDifferences (*squareDifferences)(const uchar* pixels, size_t step, ptrdiff_t next);
    //! Samples of TEMPLATE x TEMPLATE pixels, their derivatives, and these times weights.
    void (*makeTemplate)(const uchar* pixels, size_t step, const PatchWeights& weights, PatchTemplate& out);
    //! The sums of samples.
    void (*sum)(const short* samples, const PatchWeights& weights, const PatchTemplate& patch, int* sums);
    //! The sums of weighted derivatives times derivatives, j <= i, in rows.
    void (*sumProducts)(const PatchTemplate& patch, int (*sums)[PARAMETERS]);
    //! What gain (in 2^-GAIN_BITS) times the template plus offset (so, too) leaves of samples, times half their
    //! weights.
    void (*subtract)(const short* samples, const PatchWeights& weights, const PatchTemplate& patch, int gain,
            int offset, short* residuals);
    Autocorrelation (*autocorrelate)(const short* values);
};

//! The kernels for this machine.
const RefinementKernels& refinementKernels();

}}  // namespace cv::iib
