// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#pragma once

#include "../../common/aligned_buffer.hpp"

namespace cv { namespace iib {

//! Pixels, means and differences are grey levels of 0..255 in 2^-7.
constexpr int GREY_BITS = 7;
constexpr int WHITE = 255 << GREY_BITS;

/* Kernels for rows. 8-bit pixels have no padding. A `half` row has half as many values as the other rows. All but gain work on
 integers; gain uses floats in one order of operations, with exact square roots and quotients. */
struct NormalizationKernels
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
};

//! The kernels for this machine.
const NormalizationKernels& normalizationKernels();

}}  // namespace cv::iib
