// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#pragma once

#include "aligned_buffer.hpp"

namespace cv {
namespace iib {

/** Rows of an image as kernels take them: each begins on a cache line, with room for `reach` values and ROW_PADDING
more on either side. They may be fewer than the image has: then the last ones, of those made from top to bottom. */
template <typename T> class PaddedRows
{
public:
    //! Not initialized, or zeros.
    explicit PaddedRows(Size size_, int reach = 0, bool zeros = false)
        : size(size_), padding(wholeLines<T>(reach + ROW_PADDING)),
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

}  // namespace iib
}  // namespace cv
