// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#pragma once

#include "kernels/kernels.hpp"
#include "regions.hpp"

namespace cv {
namespace iib {

//! A channel's values are whole numbers >= 0, so that sums over cells are exact.
struct Channel
{
    int kind;  //!< a single IIBDescriptorExtractor::Channel, or 0 for an extra channel
    Mat map;   //!< the image (all kinds but 0) or the extra map, CV_8U or CV_16U
};

//! The channels in use, in the order of the descriptor. @param grey the image as a map. @param extra maps as given.
std::vector<Channel> channelsInUse(
        const Parameters& parameters, const Mat& grey, const std::vector<Mat>& extra);

//! Largest pixel value of CV_8U or CV_16U.
inline int maxPixel(int depth) { return depth == CV_8U ? 255 : 65535; }

//! Whether the channel is computed from the image's gradient.
inline bool usesGradient(const Channel& channel)
{
    return channel.kind != 0 && channel.kind != IIB::CHANNEL_INTENSITY;
}

//! Whether any map has 16 bits.
bool is16Bit(const std::vector<Channel>& channels);

//! Largest absolute Sobel response of the image behind these channels; 0 if none needs its gradient.
int maxGradient(const std::vector<Channel>& channels);

/** The largest value of some channels, where no gradient exceeds `gradient`. Signed gradients have it added,
 which changes no comparison and keeps them positive. */
int maxValue(const Channel* channels, int count, int gradient);

/** The rows of a group of channels over a rectangle, one at a time from the top. Where the rectangle leaves the image, the
 channels are reflected (BORDER_REFLECT_101). */
template <typename T> class ChannelRows
{
public:
    //! @param channels 1 to GROUP_CHANNELS; they, the kernels and the memory outlive the object.
    //! @param signedOffset added to signed gradients, to keep them positive.
    ChannelRows(const std::vector<Channel>& channels, Rect area, int signedOffset,
            const RowKernels<T>& kernels, ScratchMemory& memory);

    //! Moves on to row y, the one after the last row or any row.
    //! @return GROUP_CHANNELS channels in the row, at the pixels of the rectangle; missing ones repeat the last.
    const T* const* compute(int y);

    /** The same into memory of the caller, rowSize() values.
     @param above if not 0, each value has the one so many places behind its own added, modulo 2^16 or 2^32; for channels
     of the image alone. */
    void compute(int y, T* out, ptrdiff_t above = 0);

    //! Values in a row of all channels that the caller keeps, and where each has the rectangle's first pixel in it.
    size_t rowSize() const { return GROUP_CHANNELS * step; }
    const size_t* places() const { return placeOf; }

private:
    // Rows of the scratch memory: three of the image in turn, the channels.
    static constexpr int IMAGE_ROWS = 3, FIRST_PLANE = IMAGE_ROWS,
                         SCRATCH_ROWS = FIRST_PLANE + GROUP_CHANNELS;

    ImageRows<T> imageRows(int y);
    ImageChannelRows<T> imageChannels(T* out) const;
    void reflect(T* out) const;
    T* row(int i) { return scratch + i * step; }

    const std::vector<Channel>& channels;
    const Rect area;
    const Range source;  //!< columns of the image that the rectangle shows, also reflected
    const int origin;    //!< the first column of the rows of channels
    const T signedOffset;
    const RowKernels<T>& kernels;
    const Mat* gradientOf;  //!< the image, or null if no channel needs its gradient
    int read[IMAGE_ROWS];   //!< which row of the image each of the first three scratch rows holds
    size_t step;
    T* const scratch;
    size_t placeOf[GROUP_CHANNELS];
    const T* planes[GROUP_CHANNELS];
};

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
