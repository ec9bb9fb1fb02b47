// SPDX-License-Identifier: Apache-2.0
#include "perf_precomp.hpp"

namespace opencv_test { namespace {

const Matx33d CAMERA(500, 0, 320, 0, 500, 240, 0, 0, 1);

//! 200 matches, a fifth of them wrong, of a camera that moved one step to the right; points are .2 pixels off.
void makeMatches(Mat& points1, Mat& points2)
{
    RNG random(1);
    points1.create(200, 2, CV_64F);
    points2.create(200, 2, CV_64F);
    for (int i = 0; i < points1.rows; i++)
    {
        const double y = random.uniform(0., 480.), x = random.uniform(0., 640.),
                     shift = 500 / random.uniform(4., 12.);
        points1.at<Vec2d>(i)[1] = y + random.gaussian(.2);
        points1.at<Vec2d>(i)[0] = x + random.gaussian(.2);
        points2.at<Vec2d>(i)[1] = i % 5 ? y - random.gaussian(.2) : random.uniform(0., 480.);
        points2.at<Vec2d>(i)[0] = i % 5 ? x - shift - random.gaussian(.2) : random.uniform(0., 640.);
    }
}

PERF_TEST(RelativePose, findRelativePose)
{
    Mat points1, points2, R, t, covariance;
    makeMatches(points1, points2);
    const Threads one(1);
    TEST_CYCLE()
    ASSERT_TRUE(findRelativePose(points1, points2, CAMERA, CAMERA, R, t, noArray(), 0, covariance));
    SANITY_CHECK_NOTHING();
}

//! OpenCV's own estimator, for comparison.
PERF_TEST(RelativePose, findEssentialMat_MAGSAC)
{
    Mat points1, points2, R, t;
    makeMatches(points1, points2);
    const Threads one(1);
    TEST_CYCLE()
    {
        const Mat E = findEssentialMat(points1, points2, Mat(CAMERA), USAC_MAGSAC, .9999, .35);
        ASSERT_EQ(3, E.rows);
        recoverPose(E, points1, points2, Mat(CAMERA), R, t);
    }
    SANITY_CHECK_NOTHING();
}

}}  // namespace opencv_test
