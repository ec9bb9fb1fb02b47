// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "channels.hpp"

#include "../common/image_input.hpp"

namespace cv { namespace iib {

std::vector<Channel> channelsInUse(const Parameters& p, const Mat& grey, const std::vector<Mat>& extra)
{
    std::vector<Channel> channels;
    size_t maps = 0;
    for (int kind : p.channelKinds())
        channels.push_back(Channel{kind, kind ? grey : integerMap(extra[maps++])});
    return channels;
}

bool is16Bit(const std::vector<Channel>& channels)
{
    return std::any_of(
            channels.begin(), channels.end(), [](const Channel& c) { return c.map.depth() == CV_16U; });
}

int maxValue(const Channel* channels, int count, int gradient)
{
    int largest = 0;
    for (int i = 0; i < count; i++)
    {
        const Channel& c = channels[i];
        int value = gradient;
        if (!usesGradient(c))
            value = maxPixel(c.map.depth());
        else if (c.kind == IIB::CHANNEL_ORIENTATION)
            value = ORIENTATION_STEPS - 1;
        else if (c.kind == IIB::CHANNEL_SIGNED_GRAD_X || c.kind == IIB::CHANNEL_SIGNED_GRAD_Y)
            value = 2 * gradient;
        largest = std::max(largest, value);
    }
    return largest;
}

ChannelBounds::ChannelBounds(const std::vector<Channel>& channels) : gradient(0)
{
    for (const Channel& c : channels)
        if (usesGradient(c))
            gradient = 4 * maxPixel(c.map.depth());
    value = maxValue(channels.data(), (int)channels.size(), gradient);
}

template <typename T>
static void widen(const RowKernels<T>& kernels, const Mat& map, int y, int x, T* out, int width)
{
    if (map.depth() == CV_8U)
        kernels.widen8u(map.ptr<uchar>(y) + x, out, width);
    else
        kernels.widen16u(map.ptr<ushort>(y) + x, out, width);
}

template <typename T>
ChannelRows<T>::ChannelRows(const std::vector<Channel>& channels_, Rect area_, int signedOffset_,
        const RowKernels<T>& kernels_, ScratchMemory& memory)
    : channels(channels_), area(area_),
      source(reflectedRange(area_.x, area_.x + area_.width, channels_[0].map.cols)),
      origin(std::min(area_.x, source.start)), signedOffset((T)signedOffset_), kernels(kernels_),
      gradientOf(0),
      step(wholeLines<T>((size_t)std::max(area_.x + area_.width, source.end) - origin + 2 + ROW_PADDING)),
      scratch(memory.get<T>(SCRATCH_ROWS * step))
{
    for (const Channel& c : channels)
        if (usesGradient(c))
            gradientOf = &c.map;
    for (int& y : read)
        y = -1;
    for (int i = 0; i < GROUP_CHANNELS; i++)
    {
        placeOf[i] = std::min(i, (int)channels.size() - 1) * step + (area.x - origin);
        planes[i] = row(FIRST_PLANE) + placeOf[i];
    }
}

template <typename T> ImageChannelRows<T> ChannelRows<T>::imageChannels(T* out) const
{
    ImageChannelRows<T> rows = ImageChannelRows<T>();
    for (size_t i = 0; i < channels.size(); i++)
        if (channels[i].kind)
            rows.of[planeOf(channels[i].kind)] = out + i * step + (source.start - origin);
    return rows;
}

template <typename T> ImageRows<T> ChannelRows<T>::imageRows(int y)
{
    const T* around[3];
    for (int i = 0; i < 3; i++)
    {
        // BORDER_REPLICATE, as in the paper's reference
        const int imageY = std::min(std::max(y + i - 1, 0), gradientOf->rows - 1);
        T* out = row(imageY % IMAGE_ROWS);
        around[i] = out;
        if (read[imageY % IMAGE_ROWS] == imageY)
            continue;
        read[imageY % IMAGE_ROWS] = imageY;
        widen(kernels, *gradientOf, imageY, source.start, out + 1, source.size());
        const int left = std::max(source.start - 1, 0), right = std::min(source.end, gradientOf->cols - 1);
        widen(kernels, *gradientOf, imageY, left, out, 1);
        widen(kernels, *gradientOf, imageY, right, out + source.size() + 1, 1);
    }
    return {around[0], around[1], around[2]};
}

//! Fills the pixels outside the image.
template <typename T> void ChannelRows<T>::reflect(T* out) const
{
    const int width = channels[0].map.cols, end = area.x + area.width;
    T* const pixels = out - origin;
    // fast copies for one reflection; then the pixels that are reflected twice
    const int left = std::min(-area.x, width - 1), right = std::min(end - width, width - 1);
    if (left > 0)
        std::reverse_copy(pixels + 1, pixels + 1 + left, pixels - left);
    if (right > 0)
        std::reverse_copy(pixels + width - 1 - right, pixels + width - 1, pixels + width);
    for (int x = area.x; x < -left; x++)
        pixels[x] = pixels[reflected(x, width)];
    for (int x = width + right; x < end; x++)
        pixels[x] = pixels[reflected(x, width)];
}

template <typename T> const T* const* ChannelRows<T>::compute(int y)
{
    compute(y, row(FIRST_PLANE));
    return planes;
}

template <typename T> void ChannelRows<T>::compute(int y, T* out, ptrdiff_t above)
{
    y = reflected(y, channels[0].map.rows);
    if (gradientOf)
        kernels.imageChannels(imageRows(y), signedOffset, imageChannels(out), above, source.size());
    for (size_t i = 0; i < channels.size(); i++, out += step)
    {
        if (channels[i].kind == 0 || !gradientOf)
            widen(kernels, channels[i].map, y, source.start, out + (source.start - origin), source.size());
        reflect(out);
    }
}

template class ChannelRows<short>;
template class ChannelRows<int>;

}}  // namespace cv::iib
