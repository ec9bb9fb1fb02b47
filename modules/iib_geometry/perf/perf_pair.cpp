// SPDX-License-Identifier: Apache-2.0
#include "perf_precomp.hpp"

namespace opencv_test { namespace {

const Matx33d CAMERA(518.4, 0, 319.5, 0, 518.4, 239.5, 0, 0, 1);

//! From two images to a pose with its covariance, by the recommended chain.
bool findPose(const Mat images[2], int points, Mat& R, Mat& t, Mat& covariance)
{
    const Ptr<IIB> iib = IIB::createRecommended(points);
    std::vector<KeyPoint> keypoints[2];
    Mat codes[2], points1, points2;
    for (int i = 0; i < 2; i++)
        iib->detectAndCompute(images[i], noArray(), keypoints[i], codes[i]);
    std::vector<DMatch> matches;
    HierarchicalMatcher::createRecommended()->match(codes[0], codes[1], matches);
    propagateMatches(images[0], keypoints[0], images[1], keypoints[1], matches, points1, points2);
    return findRelativePose(points1, points2, CAMERA, CAMERA, R, t, noArray(), 0, covariance);
}

typedef perf::TestBaseWithParam<tuple<int, int>> IIB_Pair;  // points, threads

PERF_TEST_P(IIB_Pair, pose, testing::Combine(testing::Values(1000, 2000, 4000), testing::Values(1, 2)))
{
    const Mat images[] = {picture("moved_noon"), picture("moved_night")};
    Mat R, t, covariance;
    const Threads some(get<1>(GetParam()));
    TEST_CYCLE() ASSERT_TRUE(findPose(images, get<0>(GetParam()), R, t, covariance));
    SANITY_CHECK_NOTHING();
}

//! Only ORB's points and codes of the two images, for comparison.
PERF_TEST_P(IIB_Pair, orb, testing::Combine(testing::Values(1000, 2000, 4000), testing::Values(1, 2)))
{
    const Mat images[] = {picture("moved_noon"), picture("moved_night")};
    const Ptr<ORB> orb = ORB::create(get<0>(GetParam()));
    std::vector<KeyPoint> keypoints;
    Mat codes;
    const Threads some(get<1>(GetParam()));
    TEST_CYCLE()
    for (const Mat& image : images)
        orb->detectAndCompute(image, noArray(), keypoints, codes);
    SANITY_CHECK_NOTHING();
}

typedef perf::TestBaseWithParam<int> IIB_PairPose;  // points

//! Only the pose, from propagated matches.
PERF_TEST_P(IIB_PairPose, findRelativePose, testing::Values(1000, 2000, 4000))
{
    PicturePair pair(GetParam());
    Mat points1, points2, R, t, covariance;
    propagateMatches(pair.images[0], pair.keypoints[0], pair.images[1], pair.keypoints[1], pair.matches,
            points1, points2);
    RecordProperty("matches", points1.rows);
    const Threads one(1);
    TEST_CYCLE()
    ASSERT_TRUE(findRelativePose(points1, points2, CAMERA, CAMERA, R, t, noArray(), 0, covariance));
    SANITY_CHECK_NOTHING();
}

}}  // namespace opencv_test
