// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#pragma once

#include "../../common/aligned_buffer.hpp"

#include <cstring>

namespace cv { namespace iib {

//! Pixels, means and differences are grey levels of 0..255 in 2^-7.
constexpr int GREY_BITS = 7;
constexpr int WHITE = 255 << GREY_BITS;

constexpr int CONTRAST_BITS = 6;  //!< smoothed rows are normalized grey levels in 2^-6

//! One smoothing step, and the Hessian of its result.
struct SmoothingStep
{
    int spacing;      //!< of the filter's five taps, in pixels
    short near, far;  //!< weights of the pixels one spacing away, and two; in 2^-16, each 0 to 16384
    int distance;     //!< of the Hessian's differences, in pixels; 0: no scale ends with this step
    float factor;     //!< response / determinant of these differences, see HessianDetector
};

//! The upper half of a float's bits, which keeps the order of positive floats and is lower for all others.
inline short upperHalf(float value)
{
    int bits;
    std::memcpy(&bits, &value, sizeof(bits));
    return (short)(bits >> 16);
}

//! Output of a row of responses.
struct ResponseRows
{
    float* values;
    short* upper;                      //!< upperHalf() of the values
    const short *before, *beforeThat;  //!< upperHalf() of the two rows above
    short* largest;                    //!< maximum of these three rows in each column
};

/* Kernels for rows. 8-bit pixels have no padding. A `half` row has half as many values as the other rows. All but gain and
 response work on integers; these use floats in one order of operations, with exact square roots and quotients. */
struct FilterKernels
{
    //! Grey levels from 8-bit pixels.
    void (*widen)(const uchar* pixels, short* out, int width);
    /** Rounded means of 4 x 4 values with the weights 1, 3, 3, 1 in both directions. Value x lies between values 2 x and
     2 x + 1; rows[i][-1] to rows[i][2 * halfWidth] are read. */
    void (*halveShorts)(const short* const rows[4], short* half, int halfWidth);
    void (*halveInts)(const int* const rows[4], int* half, int halfWidth);
    //! A quarter of the way from one row to another.
    void (*interpolate)(const short* from, const short* to, short* out, int width);
    //! Twice as many values, linearly interpolated; half[-1] and half[halfWidth] are read.
    void (*upsample)(const short* half, short* out, int halfWidth);
    //! out = centre + weight / 256 * (before + after - 2 * centre), rounded.
    void (*blur)(const int* before, const int* centre, const int* after, int weight, int* out, int width);
    void (*subtract)(const short* pixels, const short* means, short* out, int width);
    //! The same means of squared differences, in 2^-6 squared grey levels.
    void (*halveSquares)(const short* const rows[4], int* half, int halfWidth);
    //! 1024 * 40 / (standard deviation + 2).
    void (*gain)(const int* variance, short* out, int width);
    //! 128 + difference * gain as 8-bit pixels.
    void (*scale)(const short* differences, const short* gains, uchar* pixels, int width);

    //! Normalized 8-bit pixels around 128 to -127..127 in 2^-6.
    void (*centre)(const uchar* pixels, short* out, int width);
    /** out = c + near * (b + d - 2 c) + far * (a + e - 2 c) over rows a, b, c, d, e, then along the row `between`. The ends
     of rows are repeated. */
    void (*smooth)(
            const short* const rows[5], const SmoothingStep& step, short* between, short* out, int width);
    /** The determinant of the Hessian, factor * (Ixx Iyy - Ixy^2), by differences over `distance` pixels. Ixy is a quarter of
     a difference of four values, rounded. @param rows `distance` above, the row itself, `distance` below. */
    void (*response)(
            const short* const rows[3], int distance, float factor, const ResponseRows& out, int width);
    /** Finds the columns of [begin, end) where the upper half is at least `threshold`, which is positive, and not below the
     three rows of bounds in this column and its neighbours. Returns their number. */
    int (*maxima)(const short* upper, const short* const bounds[3], short threshold, int begin, int end,
            int* columns);
};

//! The kernels for this machine.
const FilterKernels& filterKernels();

}}  // namespace cv::iib
