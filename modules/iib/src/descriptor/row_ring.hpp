// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#ifndef OPENCV_IIB_DESCRIPTOR_ROW_RING_HPP
#define OPENCV_IIB_DESCRIPTOR_ROW_RING_HPP

#include "kernels/kernels.hpp"

namespace cv {
namespace iib {

/** Rows of sums that are made one after another, each from the one above it, in a ring that keeps the last of them. The ring
 stays in the cache while the keypoints that it holds are described. */
template <typename Sum> class RowRing
{
public:
    /** @param origin the first row, which is all zeros, and the first column behind the zeros at its left.
     @param count rows that a reader looks at, the newest included.
     @param values in a row, of which the first `zeros` are always 0. What follows them begins on a cache line. */
    RowRing(Point origin, int count, size_t values, size_t zeros, ScratchMemory& memory) : newest(origin.y)
    {
        const size_t inLine = CACHE_LINE / sizeof(Sum);
        // An odd number of cache lines: with an even one the corners of a column would share few cache sets.
        view.step = ((values + inLine - 1) / inLine | 1) * inLine;
        view.count = count;
        view.origin = origin;
        begin = memory.get<Sum>(count * view.step + inLine) + inLine - zeros;
        view.data = begin;
        std::fill(row(newest), row(newest) + view.step, (Sum)0);
        for (int i = 0; i < count; i++)
            std::fill(row(newest + i), row(newest + i) + zeros, (Sum)0);
    }

    //! Makes the rows after the newest one, up to row `last`: makeRow(y, row y, row y + 1) makes the latter.
    template <typename MakeRow> void advance(int last, const MakeRow& makeRow)
    {
        for (; newest < last; newest++)
            makeRow(newest, row(newest), row(newest + 1));
    }

    const RingRows<Sum>& rows() const { return view; }
    const Sum* row(int y) const { return begin + (size_t)((y - view.origin.y) % view.count) * view.step; }
    //! The first row at hand.
    int oldest() const { return std::max(newest - view.count + 1, view.origin.y); }

private:
    Sum* row(int y) { return const_cast<Sum*>(static_cast<const RowRing*>(this)->row(y)); }

    int newest;
    Sum* begin;
    RingRows<Sum> view;
};

}  // namespace iib
}  // namespace cv

#endif
