// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#ifndef OPENCV_IIB_DESCRIPTOR_SAMPLED_CHANNELS_HPP
#define OPENCV_IIB_DESCRIPTOR_SAMPLED_CHANNELS_HPP

#include "channels.hpp"
#include "kernels/kernels.hpp"

namespace cv {
namespace iib {

/** What the channels of a descriptor are sampled from, GROUP_CHANNELS values to a pixel: what the image's channels are
 made of comes first, extra maps follow. */
struct SampledChannels
{
    bool hasImage;
    std::vector<std::vector<Channel>> packs;
    std::vector<int> planeOf;  //!< of each channel, in the planes of sums

    explicit SampledChannels(const std::vector<Channel>& channels) : hasImage(false)
    {
        std::vector<Channel> maps;
        for (const Channel& c : channels)
        {
            int plane = 0;
            while (c.kind >> plane > 1)
                plane++;
            planeOf.push_back(c.kind == 0 ? -1 - (int)maps.size() : plane);
            if (c.kind == 0)
                maps.push_back(c);
            else if (!hasImage)
            {
                hasImage = true;
                const int kinds[] = {IIB::CHANNEL_SIGNED_GRAD_X, IIB::CHANNEL_SIGNED_GRAD_Y,
                        IIB::CHANNEL_ORIENTATION, IIB::CHANNEL_INTENSITY};
                packs.push_back(std::vector<Channel>());
                for (int kind : kinds)
                    packs[0].push_back(Channel{kind, c.map});
            }
        }
        for (int& plane : planeOf)
            if (plane < 0)
                plane = imagePlanes() - 1 - plane;
        for (size_t i = 0; i < maps.size(); i += GROUP_CHANNELS)
            packs.push_back(std::vector<Channel>(
                    maps.begin() + i, maps.begin() + std::min(i + GROUP_CHANNELS, maps.size())));
    }

    int imagePlanes() const { return hasImage ? IMAGE_PLANES : 0; }
    int planes() const { return imagePlanes() + GROUP_CHANNELS * ((int)packs.size() - hasImage); }
};

}  // namespace iib
}  // namespace cv

#endif
