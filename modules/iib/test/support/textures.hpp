// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#pragma once

#include "../test_precomp.hpp"

namespace opencv_test {

// Pictures and keypoints made of integers, the same on every machine.

//! Pseudorandom integers, the same everywhere (SplitMix64).
class Integers
{
public:
    explicit Integers(uint64 seed) : state(seed) {}
    //! 0 <= result < end
    int below(int end);
    int between(int begin, int end) { return begin + below(end - begin); }

private:
    uint64 state;
};

//! Blurred noise, CV_8U or CV_16U: gradients of all sizes, flat places too. Made of integers alone.
Mat texture(Size size, int depth, int seed);

//! Keypoints in and around an image, of all sizes and directions, some of them -1. Quarters of pixels, whole degrees.
std::vector<KeyPoint> scatter(Size size, int count, float smallest, float largest, int seed);

//! The detector's keypoints.
inline std::vector<KeyPoint> found(Feature2D& detector, InputArray image, InputArray mask = noArray())
{
    std::vector<KeyPoint> keypoints;
    detector.detect(image, keypoints, mask);
    return keypoints;
}

//! Number of bits that differ; fails if the sizes or types do.
int differingBits(const Mat& a, const Mat& b);

void expectSameKeyPoints(const std::vector<KeyPoint>& expected, const std::vector<KeyPoint>& actual);

//! Expects that make() gives the same with every number of threads, and each time, by expectSame(expected, actual).
template <typename Make, typename Expect>
void forEveryNumberOfThreads(const Make& make, const Expect& expectSame)
{
    const int before = getNumThreads();
    setNumThreads(1);
    const auto expected = make();
    for (int threads : {1, 2, 3, 8})
    {
        SCOPED_TRACE(format("%d threads", threads));
        setNumThreads(threads);
        expectSame(expected, make());
    }
    setNumThreads(before);
}

//! FNV-1a of the bytes of all rows.
uint64 hashOf(const Mat& m);

}  // namespace opencv_test
