// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#pragma once

#include "test_precomp.hpp"

namespace opencv_test {

//! Random descriptors in clusters, so that there are near ones, equal ones and ties.
inline Mat randomDescriptors(uint64 seed, int rows, int bytes)
{
    RNG rng(seed), centres(7);
    Mat base(16, bytes, CV_8U), result(rows, bytes, CV_8U);
    centres.fill(base, RNG::UNIFORM, 0, 256);
    for (int i = 0; i < rows; i++)
    {
        base.row(rng.uniform(0, base.rows)).copyTo(result.row(i));
        for (int flips = rng.uniform(0, bytes * 2); flips > 0; flips--)
        {
            const int bit = rng.uniform(0, 8), byte = rng.uniform(0, bytes);
            result.at<uchar>(i, byte) ^= (uchar)(1 << bit);
        }
    }
    return result;
}

inline int hammingDistance(const uchar* a, const uchar* b, int bytes)
{
    int distance = 0;
    for (int i = 0; i < bytes * 8; i++)
        distance += (a[i / 8] ^ b[i / 8]) >> i % 8 & 1;
    return distance;
}

}  // namespace opencv_test
