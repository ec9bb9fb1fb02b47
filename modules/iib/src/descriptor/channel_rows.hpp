// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#ifndef OPENCV_IIB_DESCRIPTOR_CHANNEL_ROWS_HPP
#define OPENCV_IIB_DESCRIPTOR_CHANNEL_ROWS_HPP

#include "../common/aligned_buffer.hpp"
#include "channels.hpp"

namespace cv {
namespace iib {

/* Kernels may read and write up to this many values past the end of a row. */
enum
{
    ROW_PADDING = 64
};

/* What a row of pixels goes through. T is short for 8-bit images, int for 16-bit ones. Rows begin anywhere;
 those read or written have ROW_PADDING values more than `width`. */
template <typename T> struct RowKernels
{
    //! Sobel 3x3. The three source rows begin one pixel left of gx[0] and end one pixel right of it.
    void (*gradient)(const T* above, const T* middle, const T* below, T* gx, T* gy, int width);
    //! atan2(-gy, gx) in ORIENTATION_STEPS a turn.
    void (*orientation)(const T* gx, const T* gy, T* steps, int width);
    void (*absolute)(const T* in, T* out, int width);
    void (*add)(const T* in, T addend, T* out, int width);
    void (*widen8u)(const uchar* in, T* out, int width);
    void (*widen16u)(const ushort* in, T* out, int width);
};

//! The kernels for this machine.
const RowKernels<short>& shortRowKernels();
const RowKernels<int>& intRowKernels();

/** The rows of a group of channels over a rectangle of the image, one at a time from the top. */
template <typename T> class ChannelRows
{
public:
    //! @param channels whose maps outlive the object.
    //! @param signedOffset added to signed gradients, to keep them positive.
    ChannelRows(const std::vector<Channel>& channels, Rect area, int signedOffset);

    //! Moves on to row y, the one after the last row or any row.
    void compute(int y);

    //! Channel i in the row, at the pixels of the rectangle; i < GROUP_CHANNELS, missing channels repeat the last.
    const T* plane(int i) const { return planes[i]; }

private:
    void computeGradient(int y);
    T* row(int i) { return scratch.data() + i * step; }

    const std::vector<Channel> channels;
    const Rect area;
    const T signedOffset;
    const RowKernels<T>& kernels;
    const Mat* gradientOf;  //!< the image, or null if no channel needs its gradient
    int read[3];            //!< which row of the image each of the first three scratch rows holds
    size_t step;
    AlignedBuffer<T> scratch;
    const T* planes[GROUP_CHANNELS];
};

}  // namespace iib
}  // namespace cv

#endif
