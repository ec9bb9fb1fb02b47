// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "byte_source.hpp"
#include "support/matcher_oracle.hpp"

//! Whether two answers hold the same matches in the same order.
inline bool equal(const opencv_test::Matches& a, const opencv_test::Matches& b)
{
    if (a.size() != b.size())
        return false;
    for (size_t q = 0; q < a.size(); q++)
        if (a[q].size() != b[q].size() || !std::equal(a[q].begin(), a[q].end(), b[q].begin(),
                                                  [](const cv::DMatch& x, const cv::DMatch& y) {
                                                      return x.distance == y.distance &&
                                                             x.queryIdx == y.queryIdx &&
                                                             x.imgIdx == y.imgIdx && x.trainIdx == y.trainIdx;
                                                  }))
            return false;
    return true;
}
