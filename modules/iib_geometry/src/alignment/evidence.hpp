// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "../verdict/verdict.hpp"
#include "working_pair.hpp"

namespace cv::iib {

//! What fitted transforms are judged by.
struct Evidence
{
    const AlignedPoints& points;
    const WorkingPair& pair;
    int tried;  //!< number of views in which the images were matched
    Verdict verdict;

    Evidence(const AlignedPoints& matched, const WorkingPair& images, int views)
        : points(matched), pair(images), tried(views), verdict(matched.image, matched.reference)
    {  // errors are in the reference
    }
};

}  // namespace cv::iib
