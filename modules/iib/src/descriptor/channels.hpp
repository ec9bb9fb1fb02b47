// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#ifndef OPENCV_IIB_DESCRIPTOR_CHANNELS_HPP
#define OPENCV_IIB_DESCRIPTOR_CHANNELS_HPP

#include "layout.hpp"

namespace cv {
namespace iib {

//! A channel's values are whole numbers >= 0, so that sums over cells are exact.
struct Channel
{
    int kind;  //!< a single IIBDescriptorExtractor::Channel, or 0 for an extra channel
    Mat map;   //!< the image (all kinds but 0) or the extra map, CV_8U or CV_16U
};

//! The channels in use, in the order of the descriptor.
std::vector<Channel> channelsInUse(
        const Parameters& parameters, const Mat& image, const std::vector<Mat>& extra);

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

inline int maxValue(const std::vector<Channel>& channels, int gradient)
{
    return maxValue(channels.data(), (int)channels.size(), gradient);
}

}  // namespace iib
}  // namespace cv

#endif
