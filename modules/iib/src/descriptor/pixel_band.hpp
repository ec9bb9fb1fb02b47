// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#ifndef OPENCV_IIB_DESCRIPTOR_PIXEL_BAND_HPP
#define OPENCV_IIB_DESCRIPTOR_PIXEL_BAND_HPP

#include "channel_rows.hpp"

namespace cv {
namespace iib {

/** The last rows of GROUP_CHANNELS channels, side by side in each pixel, to be sampled anywhere. Goes from the top of a
 rectangle of the image to its bottom. */
template <typename T> class PixelBand
{
public:
    //! Pixels that a band keeps; a caller that cannot afford them samples without one.
    static double pixelsKept(Rect area, int rows) { return (double)rowStep(area) * capacityFor(area, rows); }

    //! @param channels 1 to GROUP_CHANNELS; they, the kernels and the memory outlive the band.
    //! @param rows how many rows, the newest included, a reader looks at.
    PixelBand(const std::vector<Channel>& channels, Rect area_, int rows, const RowKernels<T>& kernels_,
            ScratchMemory& rowMemory, ScratchMemory& pixelMemory)
        : channelRows(channels, area_, 0, kernels_, rowMemory), kernels(kernels_), area(area_), kept(rows),
          capacity(capacityFor(area_, rows)), top(area_.y), done(area_.y), pixelStep(rowStep(area_)),
          pixels(pixelMemory.get<T>((size_t)pixelStep * capacity * GROUP_CHANNELS))
    {
    }

    //! Makes the rows up to and without `end` of the image; `end` does not decrease from call to call.
    void advance(int end)
    {
        if (end > top + capacity)
            moveTop(std::max(end - kept, area.y));
        for (; done < end; done++)
            kernels.interleave(channelRows.compute(done), row(done), area.width);
    }

    //! Pixels at hand, from the first row on, step() pixels from row to row; the first one is at origin() in the image.
    const T* data() const { return pixels; }
    int step() const { return pixelStep; }
    Point origin() const { return Point(area.x, top); }

private:
    static int rowStep(Rect area) { return area.width + ROW_PADDING; }
    // Twice the rows that are kept: each row is then moved once at most.
    static int capacityFor(Rect area, int rows) { return (int)std::min<int64>(2 * (int64)rows, area.height); }

    T* row(int y) { return pixels + (size_t)(y - top) * pixelStep * GROUP_CHANNELS; }

    void moveTop(int y)
    {
        if (done > y)
            memmove(pixels, row(y), (size_t)(done - y) * pixelStep * GROUP_CHANNELS * sizeof(T));
        done = std::max(done, y);
        top = y;
    }

    ChannelRows<T> channelRows;
    const RowKernels<T>& kernels;
    const Rect area;
    const int kept, capacity;
    int top, done;  //!< rows of the image at hand: [top, done)
    const int pixelStep;
    T* const pixels;
};

}  // namespace iib
}  // namespace cv

#endif
