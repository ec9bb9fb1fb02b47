// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#pragma once

#include "../../common/aligned_buffer.hpp"

namespace cv {
namespace iib {

constexpr int DETECTOR_PADDING = 64;  //!< values that kernels may read and write on either side of a row
//! What is normalized, pixels, means and differences, are grey levels of 0..255 in 2^-7.
constexpr int GREY_BITS = 7;
constexpr int WHITE = 255 << GREY_BITS;
constexpr int CONTRAST_BITS = 6;  //!< smoothed rows are normalized grey levels in 2^-6

/** Rows of an image as kernels take them: each begins on a cache line, with room for `reach` values and DETECTOR_PADDING
more on either side. They may be fewer than the image has: then the last ones, of those made from top to bottom. */
template <typename T> class PaddedRows
{
public:
    //! Not initialized, or zeros.
    explicit PaddedRows(Size size_, int reach = 0, bool zeros = false)
        : size(size_), padding(wholeLines<T>(reach + DETECTOR_PADDING)),
          step(wholeLines<T>(size_.width + 1) + 2 * padding), values(step * size_.height)
    {
        if (zeros)
            std::fill_n(values.data(), step * size.height, T());
    }

    T* row(int y) { return values.data() + place(y) * step + padding; }
    const T* row(int y) const { return values.data() + place(y) * step + padding; }

    //! Repeats the ends of a row of `width` values.
    void repeatEnds(int y, int width, int times = 1)
    {
        T* const r = row(y);
        std::fill_n(r - times, times, r[0]);
        std::fill_n(r + width, times, r[width - 1]);
    }

    Size size;

private:
    int place(int y) const { return y < size.height ? y : y % size.height; }

    size_t padding, step;
    AlignedBuffer<T> values;
};

//! Weights of (near: 1, far: 2 spacings away) in a smoothing, in 2^-16; 0 to 16384.
struct SmoothingWeights
{
    short near, far;
};

/* What detectors do with rows. Pixels of 8 bits have no padding. All is on integers but gain and response, floats in one
 order of operations, whose square root and quotient IEEE 754 rounds in one way. */
struct DetectorKernels
{
    /* Local normalization. A `half` row has half as many values as those it comes from or goes to. */

    //! Grey levels from 8-bit pixels.
    void (*widen)(const uchar* pixels, short* out, int width);
    //! Means of 2 x 2 values, rounded.
    void (*halveShorts)(const short* upper, const short* lower, short* half, int halfWidth);
    void (*halveInts)(const int* upper, const int* lower, int* half, int halfWidth);
    //! A quarter of the way from one row to another.
    void (*interpolate)(const short* from, const short* to, short* out, int width);
    //! Twice as many values, linearly interpolated; half[-1] and half[halfWidth] are read.
    void (*upsample)(const short* half, short* out, int halfWidth);
    //! out = centre + weight / 256 * (before + after - 2 * centre), rounded.
    void (*blur)(const int* before, const int* centre, const int* after, int weight, int* out, int width);
    void (*subtract)(const short* pixels, const short* means, short* out, int width);
    //! Means of the squares of 2 x 2 differences, in 2^-6 squared grey levels.
    void (*squares)(const short* upper, const short* lower, int* half, int halfWidth);
    //! 1024 * 40 / (standard deviation + 2).
    void (*gain)(const int* variance, short* out, int width);
    //! 128 + difference * gain as 8-bit pixels.
    void (*scale)(const short* differences, const short* gains, uchar* pixels, int width);

    /* Blobs. */

    //! Normalized 8-bit pixels around 128 to -127..127 in 2^-6.
    void (*centre)(const uchar* pixels, short* out, int width);
    //! out = c + near * (b + d - 2 c) + far * (a + e - 2 c) of rows a, b, c, d, e.
    void (*smooth)(const short* const rows[5], SmoothingWeights weights, short* out, int width);
    //! factor * (Ixx Iyy - Ixy^2) by differences over `distance` pixels; rows: `distance` above, at and below.
    void (*response)(const short* const rows[3], int distance, float factor, float* out, int width);
    //! The largest of 3 x 3 values.
    void (*largest)(const float* const rows[3], float* out, int width);
    /** Columns from `begin` to before `end` where the value is at least `threshold`, which is positive, and at least what
     three rows hold there. Returns their number. */
    int (*maxima)(const float* values, const float* const bounds[3], float threshold, int begin, int end,
            int* columns);
};

//! The kernels for this machine.
const DetectorKernels& detectorKernels();

}  // namespace iib
}  // namespace cv
