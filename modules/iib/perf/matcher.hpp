// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#pragma once

#include "perf_precomp.hpp"

namespace opencv_test {

//! Keypoints, descriptors and matches of two pictures by the recommended chain: the demo's street at noon, and by night from
//! another place.
struct PicturePair
{
    explicit PicturePair(int points)
    {
        const Ptr<IIB> iib = IIB::createRecommended(points);
        for (int i = 0; i < 2; i++)
        {
            images[i] = picture(i ? "moved_night" : "moved_noon");
            iib->detectAndCompute(images[i], noArray(), keypoints[i], codes[i]);
        }
        HierarchicalMatcher::createRecommended()->match(codes[0], codes[1], matches);
    }

    Mat images[2], codes[2];
    std::vector<KeyPoint> keypoints[2];
    std::vector<DMatch> matches;
};

}  // namespace opencv_test
