// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#pragma once

#include "../precomp.hpp"

namespace cv { namespace iib {

//! Keypoints that are described together, from integral images over their common area.
struct KeyPointBatch
{
    Rect area;  //!< contains all their regions
    int rows;   //!< of the highest region
    //! Indices, sorted by the band in which the region ends, then from left to right.
    std::vector<int> keypoints;

    static constexpr int BAND_ROWS = 8;  //!< keypoints of a band share sums in the cache

    //! The end of the band in which a region ends. @param end of the region, exclusive.
    int bandEnd(int end) const
    {
        const int bands = (end - area.y + BAND_ROWS - 1) / BAND_ROWS;
        return std::min(area.y + bands * BAND_ROWS, area.y + area.height);
    }
};

//! Rounds of cuts at gaps, alternating between the axes. More rounds could take quadratic time.
static constexpr int MAX_CUTS = 8;

/** Cuts keypoints into batches, at straight gaps between regions, in up to MAX_CUTS rounds. No batch has much more than
 1/workers of all pixels. Takes time linear in the keypoints and the pixels.

 @param regions the pixels that each keypoint of an image reads, not empty.
 @param keypoints indices of those to cut.
 @return indices of the keypoints of each batch. */
std::vector<std::vector<int>> cutBatches(
        const std::vector<Rect>& regions, const std::vector<int>& keypoints, int workers);

//! @param regions of all keypoints of an image. @param keypoints their indices, one or more.
KeyPointBatch makeBatch(const std::vector<Rect>& regions, const std::vector<int>& keypoints);

}}  // namespace cv::iib
