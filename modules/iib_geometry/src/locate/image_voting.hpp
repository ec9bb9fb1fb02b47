// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "opencv2/core.hpp"

namespace cv::iib {

/** Finds similar images by locality-sensitive hashing. Each code votes for the map's images that have a code with the
same random bits, in several tables. The number of bits grows with the map, so that a larger map takes no longer. */
class ImageVoting
{
public:
    //! @param codes of each image, strongest keypoints first; may be empty.
    explicit ImageVoting(const std::vector<Mat>& codes);

    struct Votes
    {
        std::vector<float> ofImages;
        size_t visited;  //!< number of the map's codes that were visited
    };
    Votes vote(const Mat& codes) const;

private:
    struct Table
    {
        std::vector<int> bits;
        std::vector<uint32_t> begins;  //!< index of each key's first entry
        std::vector<uint32_t> images;  //!< entries sorted by key
    };

    static uint32_t keyOf(const uchar* code, const std::vector<int>& bits);

    size_t images_;
    std::vector<Table> tables_;
};

}  // namespace cv::iib
