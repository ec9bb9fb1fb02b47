// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#ifndef OPENCV_IIB_TEST_SUPPORT_TEST_IMAGES_HPP
#define OPENCV_IIB_TEST_SUPPORT_TEST_IMAGES_HPP

#include "../test_precomp.hpp"

namespace opencv_test {

using cv::iib::IIB;

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

//! Polygons and ellipses in front of each other, CV_8U.
Mat scene(Size size, int seed);

//! Nine numbers of a text file; the identity if there is no such file.
Matx33d readHomography(const String& file);

//! The scene by another light: dimmed, from the side, with the camera's curve and noise.
Mat relit(const Mat& image, int seed);

//! Keypoints in and around an image, of all sizes and directions, some of them -1. Quarters of pixels, whole degrees.
std::vector<KeyPoint> scatter(Size size, int count, float smallest, float largest, int seed);

//! Computes descriptors and expects that the keypoints stay as they are.
Mat describe(IIB& iib, InputArray image, const std::vector<KeyPoint>& keypoints,
        InputArrayOfArrays extra = noArray());

//! Number of bits that differ; fails if the sizes or types do.
int differingBits(const Mat& a, const Mat& b);

void expectSameKeyPoints(const std::vector<KeyPoint>& expected, const std::vector<KeyPoint>& actual);

}  // namespace opencv_test

#endif
