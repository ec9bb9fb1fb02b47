// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#ifndef OPENCV_IIB_INTEGRAL_HPP
#define OPENCV_IIB_INTEGRAL_HPP

#include "../../common/aligned_buffer.hpp"
#include "../channel_rows.hpp"

namespace cv {
namespace iib {

/** What a reader sees of integral images of GROUP_CHANNELS channels, side by side in each pixel: the last rows,
 in a ring. Sums are modulo 2^16 (Sum = ushort) or 2^32 (unsigned): a cell's sum, as the difference of its
 corners, is right if it is below that, however large the image. */
template <typename Sum> struct IntegralRows
{
    const Sum* data;
    size_t step;   //!< elements from row to row
    int count;     //!< rows in the ring
    Point origin;  //!< in the image

    /* Row (y - origin.y) % count has the sums over the image's rows [origin.y, y), left of the pixels origin.x,
     origin.x + 1, ... */
};

//! From a row of each channel: out = above + sums along the row; both begin left of the first pixel, with 0.
template <typename T, typename Sum> struct SumRowFunc
{
    typedef void (*Type)(const T* const planes[GROUP_CHANNELS], int width, const Sum* above, Sum* out);
};
SumRowFunc<short, ushort>::Type getSumRowFunc(short, ushort);
SumRowFunc<short, unsigned>::Type getSumRowFunc(short, unsigned);
SumRowFunc<int, unsigned>::Type getSumRowFunc(int, unsigned);

//! Bytes of a row of the ring, for a rectangle of this width.
size_t integralRowBytes(int width, size_t bytesPerSum);

/** Makes the rows, from the top of a rectangle of the image to its bottom. The ring stays in the cache while the
 keypoints that it holds are described. */
template <typename T, typename Sum> class IntegralBand
{
public:
    //! @param channels 1 to 4, whose maps outlive the band.
    //! @param rows how many rows, the newest included, a reader looks at.
    IntegralBand(const std::vector<Channel>& channels, Rect area, int rows)
        : channelRows(channels, area, maxGradient(channels)), width(area.width), done(area.y),
          sumRow(getSumRowFunc(T(), Sum()))
    {
        view.step = integralRowBytes(area.width, sizeof(Sum)) / sizeof(Sum);
        view.count = rows;
        view.origin = area.tl();
        ring.allocate(rows * view.step + CACHE_LINE / sizeof(Sum));
        // Pixels begin on a cache line, behind the zeros to their left.
        begin = ring.data() + CACHE_LINE / sizeof(Sum) - GROUP_CHANNELS;
        view.data = begin;
        std::fill(row(done), row(done) + view.step, (Sum)0);  // nothing is above the first row
        for (int i = 0; i < rows; i++)
            std::fill(row(done + i), row(done + i) + GROUP_CHANNELS, (Sum)0);  // nor left of the first pixel
    }

    //! Adds the image's rows up to and without y, area.y <= y <= area.y + area.height.
    void advance(int y)
    {
        for (; done < y; done++)
        {
            channelRows.compute(done);
            const T* planes[GROUP_CHANNELS];
            for (int i = 0; i < GROUP_CHANNELS; i++)
                planes[i] = channelRows.plane(i);
            sumRow(planes, width, row(done), row(done + 1));
        }
    }

    const IntegralRows<Sum>& rows() const { return view; }

private:
    Sum* row(int y) { return begin + (y - view.origin.y) % view.count * view.step; }

    ChannelRows<T> channelRows;
    const int width;
    int done;  //!< rows of the image above this one are in the newest row
    const typename SumRowFunc<T, Sum>::Type sumRow;
    AlignedBuffer<Sum> ring;
    Sum* begin;
    IntegralRows<Sum> view;
};

}  // namespace iib
}  // namespace cv

#endif
