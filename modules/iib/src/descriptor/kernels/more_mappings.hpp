// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#pragma once

#include "mappings.hpp"

namespace cv { namespace iib {

// Mappings that the paper does not have.

//! Left > right, top > bottom, main > other diagonal.
struct HaarMapping
{
    static constexpr int BITS = 3;

    template <typename V, typename Put> static void map(const V x[4], const Put& put)
    {
        put(0, x[0] + x[2] > x[1] + x[3]);
        put(1, x[0] + x[1] > x[2] + x[3]);
        put(2, x[0] + x[3] > x[1] + x[2]);
    }
};

//! Each cell > the next, around the quad.
struct PairwiseMapping
{
    static constexpr int BITS = 4;

    template <typename V, typename Put> static void map(const V x[4], const Put& put)
    {
        put(0, x[0] > x[1]);
        put(1, x[1] > x[3]);
        put(2, x[3] > x[2]);
        put(3, x[2] > x[0]);
    }
};

}}  // namespace cv::iib
