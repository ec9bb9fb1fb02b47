// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "../support/test_images.hpp"

namespace opencv_test {
namespace {

//! FNV-1a of the bits of floats.
uint64 hashOf(const Mat& floats)
{
    uint64 hash = CV_BIG_UINT(0xcbf29ce484222325);
    for (int i = 0; i < (int)floats.total(); i++)
        for (int shift = 0; shift < 32; shift += 8)
        {
            Cv32suf bits;
            bits.f = floats.ptr<float>()[i];
            hash = (hash ^ (bits.u >> shift & 255)) * CV_BIG_UINT(0x100000001b3);
        }
    return hash;
}

// The same bits on every machine and build. Images and keypoints are made of integers alone. A change of the algorithm may
// change them; then the numbers are those that a failure prints.
TEST(IIB_RefinementGolden, bits)
{
    const Mat whole = texture(Size(330, 250), CV_8U, 11);
    const Mat first = whole(Rect(5, 4, 320, 240)).clone();
    Mat second = whole(Rect(7, 7, 320, 240)).clone();
    for (int y = 0; y < second.rows; y++)
        for (int x = 0; x < second.cols; x++)
            second.at<uchar>(y, x) = (uchar)(second.at<uchar>(y, x) * (300 + x) / 700 + 20);
    const std::vector<KeyPoint> keypoints = scatter(first.size(), 120, 8, 30, 3);
    std::vector<KeyPoint> moved = keypoints;
    std::vector<DMatch> matches;
    for (int i = 0; i < (int)moved.size(); i++)
    {
        moved[i].pt += Point2f(i % 5 * .25f - 2.5f, i % 3 * .5f - 3.5f);
        moved[i].size *= i % 4 == 0 ? 1.25f : 1.f;
        moved[i].angle += i % 7 == 0 && moved[i].angle >= 0 ? 3 : 0;
        matches.push_back(DMatch(i, i, 0));
    }
    Mat points1, points2, covariances, similarities;
    refineMatches(first, keypoints, second, moved, matches, points1, points2, covariances, similarities);
    EXPECT_GT(countNonZero(similarities > 0), 60);
    EXPECT_EQ(CV_BIG_UINT(0xbb5ccb69321e5e06), hashOf(points2)) << std::hex << hashOf(points2);
    EXPECT_EQ(CV_BIG_UINT(0x8ebd73d555873592), hashOf(covariances)) << std::hex << hashOf(covariances);
    EXPECT_EQ(CV_BIG_UINT(0x8af67a743e1a48ad), hashOf(similarities)) << std::hex << hashOf(similarities);
    matches.resize(40);
    propagateMatches(first, keypoints, second, moved, matches, points1, points2);
    EXPECT_GT(points2.rows, 55);
    EXPECT_EQ(CV_BIG_UINT(0xe176db79d01a2067), hashOf(points2)) << std::hex << hashOf(points2);
}

}  // namespace
}  // namespace opencv_test
