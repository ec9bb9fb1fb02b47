// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#pragma once

#include "kernels/kernels.hpp"
#include "regions.hpp"

namespace cv { namespace iib {

//! A channel's values are whole numbers >= 0, so that sums over cells are exact.
struct Channel
{
    int kind;  //!< a single IIBDescriptorExtractor::Channel, or 0 for an extra channel
    Mat map;   //!< the image (all kinds but 0) or the extra map, CV_8U or CV_16U
};

//! The channels in use, in the order of the descriptor. @param grey of the image. @param extra the user's maps.
std::vector<Channel> channelsInUse(
        const Parameters& parameters, const Mat& grey, const std::vector<Mat>& extra);

inline int maxPixel(int depth) { return depth == CV_8U ? 255 : 65535; }

//! Whether the channel is computed from the image's gradient.
inline bool usesGradient(const Channel& channel)
{
    return channel.kind != 0 && channel.kind != IIB::CHANNEL_INTENSITY;
}

bool is16Bit(const std::vector<Channel>& channels);

//! The largest value of some channels. @param gradient bound of gradients; it is added to signed ones to make them positive.
int maxValue(const Channel* channels, int count, int gradient);

//! Upper bounds of some channels.
struct ChannelBounds
{
    int gradient;  //!< of the image's absolute Sobel response; 0 if no channel needs it
    int value;     //!< see maxValue()

    explicit ChannelBounds(const std::vector<Channel>& channels);
};

/** The rows of a group of channels over a rectangle, one at a time from the top. Where the rectangle leaves the image,
 the channels are reflected (BORDER_REFLECT_101). */
template <typename T> class ChannelRows
{
public:
    //! @param channels 1 to GROUP_CHANNELS; they, the kernels and the memory outlive the object.
    //! @param signedOffset added to signed gradients, to make them positive.
    ChannelRows(const std::vector<Channel>& channels, Rect area, int signedOffset,
            const RowKernels<T>& kernels, ScratchMemory& memory);

    //! Computes row y; successive rows are fastest.
    //! @return GROUP_CHANNELS channels at the pixels of the rectangle; missing ones repeat the last.
    const T* const* compute(int y);

    /** The same into the caller's memory, rowSize() values.
     @param above if not 0, out[above + i] is added to out[i], modulo 2^16 or 2^32. Not with extra channels. */
    void compute(int y, T* out, ptrdiff_t above = 0);

    //! Size of a row of all channels, and the places of the rectangle's first pixel in it.
    size_t rowSize() const { return GROUP_CHANNELS * step; }
    const size_t* places() const { return placeOf; }

private:
    // rows of the scratch memory: a ring of three rows of the image, then the channels
    static constexpr int IMAGE_ROWS = 3, FIRST_PLANE = IMAGE_ROWS,
                         SCRATCH_ROWS = FIRST_PLANE + GROUP_CHANNELS;

    ImageRows<T> imageRows(int y);
    ImageChannelRows<T> imageChannels(T* out) const;
    void reflect(T* out) const;
    T* row(int i) { return scratch + i * step; }

    const std::vector<Channel>& channels;
    const Rect area;
    const Range source;  //!< columns of the image that the rectangle reads, also by reflection
    const int origin;    //!< the first column of the rows of channels
    const T signedOffset;
    const RowKernels<T>& kernels;
    const Mat* gradientOf;  //!< the image, or null if no channel needs its gradient
    int read[IMAGE_ROWS];   //!< row of the image in each of the first three scratch rows
    size_t step;
    T* const scratch;
    size_t placeOf[GROUP_CHANNELS];
    const T* planes[GROUP_CHANNELS];
};

}}  // namespace cv::iib
