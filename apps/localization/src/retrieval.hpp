// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "opencv2/core.hpp"

namespace iib_localization {

/** Finds the keyframes that look most like an image: each of its codes votes for the keyframes with a code that is the
same in some bits, for several random choices of bits (locality-sensitive hashing). The more codes there are, the more
bits are compared, so that a larger map takes no longer. */
class Retrieval
{
public:
    //! @param codes of each keyframe, of one detector, the strongest keypoints first; may be empty.
    explicit Retrieval(const std::vector<cv::Mat>& codes);

    //! Adds to the votes for each keyframe. Returns how many codes of the map were looked at.
    size_t vote(const cv::Mat& codes, std::vector<float>& votes) const;

    //! Memory that is used.
    size_t bytes() const;

private:
    struct Table
    {
        std::vector<int> bits;
        std::vector<uint32_t> begins;     //!< of each key's entries
        std::vector<uint32_t> keyframes;  //!< the entries, by their keys
    };

    static uint32_t keyOf(const uchar* code, const std::vector<int>& bits);

    int bytes_ = 0;
    std::vector<Table> tables_;
};

}  // namespace iib_localization
