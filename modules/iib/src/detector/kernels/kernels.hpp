// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#pragma once

#include "../../common/aligned_buffer.hpp"

#include <cstring>

namespace cv { namespace iib {

constexpr int CONTRAST_BITS = 6;  //!< smoothed rows are normalized grey levels in 2^-6

//! Weights of a five-tap filter, in 2^-16, each 0 to 16384: of the pixels one spacing away, and two.
struct SmoothingWeights
{
    short near, far;
};

//! Smooths the image before once more. Of the result a Hessian may be taken.
struct SmoothingStep
{
    int spacing;  //!< of the filter's five taps, in pixels
    SmoothingWeights weights;
    int distance;  //!< of the Hessian's differences, in pixels; 0: no scale ends with this step
    float factor;  //!< by which the determinant of these differences is the response, see HessianDetector
};

//! The upper half of a float's bits. Those of positive ones have their order, and all others are below them.
inline short upperHalf(float value)
{
    int bits;
    std::memcpy(&bits, &value, sizeof(bits));
    return (short)(bits >> 16);
}

//! A row of responses, and what is made with it.
struct ResponseRows
{
    float* values;
    short* upper;                      //!< their upper halves, see upperHalf()
    const short *before, *beforeThat;  //!< those of the two rows above
    short* largest;                    //!< of these three, in each column
};

/* What the detector does with rows. Pixels of 8 bits have no padding. Responses are floats in one order. */
struct DetectorKernels
{
    //! Normalized 8-bit pixels around 128 to -127..127 in 2^-6.
    void (*centre)(const uchar* pixels, short* out, int width);
    /** out = c + near * (b + d - 2 c) + far * (a + e - 2 c) of rows a, b, c, d, e, `between`, and of that along the row.
     The ends of both are repeated. */
    void (*smooth)(
            const short* const rows[5], const SmoothingStep& step, short* between, short* out, int width);
    /** The determinant of the Hessian, factor * (Ixx Iyy - Ixy^2), by differences over `distance` pixels; rows: `distance`
     above, at and below. Ixy is a quarter of a difference of four values, rounded. */
    void (*response)(
            const short* const rows[3], int distance, float factor, const ResponseRows& out, int width);
    /** Columns from `begin` to before `end` where the upper half is at least `threshold`, which is positive, and at least what
     three rows hold there and in the columns beside. Returns their number. */
    int (*maxima)(const short* upper, const short* const bounds[3], short threshold, int begin, int end,
            int* columns);
};

//! The kernels for this machine.
const DetectorKernels& detectorKernels();

}}  // namespace cv::iib
