// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#ifndef OPENCV_IIB_DESCRIPTOR_KEYPOINT_BATCHES_HPP
#define OPENCV_IIB_DESCRIPTOR_KEYPOINT_BATCHES_HPP

#include "../precomp.hpp"

namespace cv {
namespace iib {

//! Keypoints that are described together, from integral images over their common area.
struct Block
{
    Rect area;  //!< holds all their support region
    int rows;   //!< of the highest support region
    std::vector<int>
            keypoints;  //!< indices, by the band in which their support region ends, then from left to right

    enum
    {
        BAND_ROWS = 8
    };  //!< neighbours in a band find each other's sums in the cache

    //! The end of the band in which row `end` of the image, exclusive, is the last.
    int bandEnd(int end) const
    {
        const int bands = (end - area.y + BAND_ROWS - 1) / BAND_ROWS;
        return std::min(area.y + bands * BAND_ROWS, area.y + area.height);
    }
};

/** Cuts keypoints into those that are described together, so that pixels which no support region touches are left out wherever a
 straight gap between the ROS allows, and so that none has much more than 1/workers of all pixels.

 @param region the pixels that each keypoint needs, not empty.
 @return indices of the keypoints of each block. */
std::vector<std::vector<int>> cutBlocks(const std::vector<Rect>& region, int workers);

//! @param keypoints indices, one or more.
Block makeBlock(const std::vector<Rect>& region, const std::vector<int>& keypoints);

}  // namespace iib
}  // namespace cv

#endif
