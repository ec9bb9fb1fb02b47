// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "channels.hpp"

#include "kernels/orientation.hpp"

namespace cv {
namespace iib {

std::vector<Channel> channelsInUse(const Parameters& p, const Mat& image, const std::vector<Mat>& extra)
{
    std::vector<Channel> channels;
    for (int kind = 1; kind <= ALL_CHANNELS; kind <<= 1)
        if (p.channels & kind)
            channels.push_back(Channel{kind, image});
    for (const Mat& map : extra)
        channels.push_back(Channel{0, map});
    return channels;
}

bool is16Bit(const std::vector<Channel>& channels)
{
    for (const Channel& c : channels)
        if (c.map.depth() == CV_16U)
            return true;
    return false;
}

int maxGradient(const std::vector<Channel>& channels)
{
    for (const Channel& c : channels)
        if (usesGradient(c))
            return 4 * maxPixel(c.map.depth());
    return 0;
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

}  // namespace iib
}  // namespace cv
