// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "opencv2/core.hpp"

namespace cv::iib {

/** How much the images of a map look like another one: each of its codes votes for the images with a code that is the
same in some bits, for several random choices of bits (locality-sensitive hashing). The more codes there are, the more
bits are compared, so that a larger map takes no longer. */
class ImageVoting
{
public:
    //! @param codes of each image, the strongest keypoints first; may be empty.
    explicit ImageVoting(const std::vector<Mat>& codes);

    struct Votes
    {
        std::vector<float> ofImages;
        size_t visited;  //!< codes of the map that were looked at
    };
    Votes vote(const Mat& codes) const;

private:
    struct Table
    {
        std::vector<int> bits;
        std::vector<uint32_t> begins;  //!< of each key's entries
        std::vector<uint32_t> images;  //!< the entries, by their keys
    };

    static uint32_t keyOf(const uchar* code, const std::vector<int>& bits);

    size_t images_;
    std::vector<Table> tables_;
};

}  // namespace cv::iib
