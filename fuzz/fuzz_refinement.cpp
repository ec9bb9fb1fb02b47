// SPDX-License-Identifier: Apache-2.0

// refineMatches and propagateMatches with any images, keypoints and matches. Expects a cv::Exception of both for
// invalid arguments, otherwise outputs of the documented shapes: refused matches are unchanged, and added ones are as
// in the header.

#include "images.hpp"
#include "test_precomp.hpp"

#include <cmath>

namespace {

using namespace fuzz;
using namespace opencv_test;

std::vector<KeyPoint> drawKeyPoints(ByteSource& in, Size size)
{
    std::vector<KeyPoint> keypoints(in.between(0, 12));
    for (KeyPoint& kp : keypoints)
    {
        const bool wild = in.rarely(16);
        kp.pt = wild ? Point2f(in.number(), in.number())
                     : Point2f(in.between(-8, 4 * size.width) / 4.f, in.between(-8, 4 * size.height) / 4.f);
        kp.size = in.rarely(16) ? in.number() : in.between(1, 100) / 4.f;
        kp.angle = in.rarely(32) ? in.number() : in.flag() ? -1.f : (float)in.between(0, 359);
    }
    return keypoints;
}

bool allValid(const std::vector<KeyPoint>& keypoints)
{
    for (const KeyPoint& kp : keypoints)
        if (!std::isfinite(kp.pt.x) || !std::isfinite(kp.pt.y) || !std::isfinite(kp.angle) ||
                !(kp.size > 0) || !std::isfinite(kp.size))
            return false;
    return true;
}

//! The outputs of a call for each match.
struct Refined
{
    Mat points1, points2, covariances, similarities;
};

void check(const Refined& r, const std::vector<DMatch>& matches, const std::vector<KeyPoint>* keypoints)
{
    const int n = (int)matches.size();
    FUZZ_CHECK(r.points1.rows == n && r.points2.rows == n && r.covariances.rows == n &&
               r.similarities.rows == n);
    FUZZ_CHECK(n == 0 || (checkRange(r.covariances) && checkRange(r.points2 * 0)));
    for (int i = 0; i < n; i++)
    {
        const Point2f first = keypoints[0][matches[i].queryIdx].pt,
                      second = keypoints[1][matches[i].trainIdx].pt;
        const float similarity = r.similarities.at<float>(i);
        FUZZ_CHECK(r.points1.at<Point2f>(i) == first);
        FUZZ_CHECK(
                similarity == -1 ? r.points2.at<Point2f>(i) == second : similarity > .5f && similarity <= 1);
        FUZZ_CHECK(r.covariances.at<float>(i, 0) >= 0 && r.covariances.at<float>(i, 2) >= 0);
    }
}

bool equal(const Mat& few, const Mat& more)
{
    return few.empty() || cvtest::norm(few, more.rowRange(0, few.rows), NORM_INF) == 0;
}

//! Checks the matches that were added to the given ones.
void checkAdded(const std::vector<DMatch>& matches, size_t given, const Mat& similarities)
{
    for (size_t i = given; i < matches.size(); i++)
    {
        FUZZ_CHECK(similarities.at<float>((int)i) > .7f && matches[i].distance == DMatch().distance);
        for (size_t k = 0; k < i; k++)
            FUZZ_CHECK(
                    matches[k].queryIdx != matches[i].queryIdx && matches[k].trainIdx != matches[i].trainIdx);
    }
}

}  // namespace

FUZZ_TARGET
{
    Mat images[2];
    std::vector<KeyPoint> keypoints[2];
    for (int i = 0; i < 2; i++)
    {
        const Size size = in.flag() ? Size(in.between(1, 99), in.between(1, 80)) : drawSize(in);
        images[i] = drawImage(in, size, in.rarely(32));
        keypoints[i] = drawKeyPoints(in, size);
    }
    const bool alike = in.flag();  // matches are right, so that they propagate
    if (alike || in.flag())
        images[1] = images[0];
    if (alike)
        keypoints[1] = keypoints[0];
    useThreads(in.rarely(128) ? 3 : 1);
    std::vector<DMatch> matches(in.between(0, alike ? (int)keypoints[0].size() : 8));
    const auto drawIndex = [&](int image) {
        return in.rarely(64) ? in.between(-1, 13)
                             : in.between(0, std::max((int)keypoints[image].size() - 1, 0));
    };
    bool valid = true;
    for (DMatch& m : matches)
    {
        m.queryIdx = alike ? (int)(&m - matches.data()) : drawIndex(0);
        m.trainIdx = alike && !in.rarely(16) ? m.queryIdx : drawIndex(1);
        valid = valid && m.queryIdx >= 0 && m.queryIdx < (int)keypoints[0].size() && m.trainIdx >= 0 &&
                m.trainIdx < (int)keypoints[1].size();
    }
    for (int i = 0; i < 2; i++)
        valid = valid && allValid(keypoints[i]) && !images[i].empty() && isImage(images[i]);
    valid = valid || matches.empty();  // then nothing else is read
    Refined alone, propagated;
    FUZZ_CHECK(refused([&] {
        refineMatches(images[0], keypoints[0], images[1], keypoints[1], matches, alone.points1, alone.points2,
                alone.covariances, alone.similarities);
    }) == !valid);
    std::vector<DMatch> more = matches;
    FUZZ_CHECK(refused([&] {
        propagateMatches(images[0], keypoints[0], images[1], keypoints[1], more, propagated.points1,
                propagated.points2, propagated.covariances, propagated.similarities);
    }) == !valid);
    FUZZ_CHECK(more.size() >= matches.size() && (valid || more.size() == matches.size()));
    for (size_t i = 0; i < matches.size(); i++)
        FUZZ_CHECK(more[i].queryIdx == matches[i].queryIdx && more[i].trainIdx == matches[i].trainIdx);
    if (!valid)
        return;
    check(alone, matches, keypoints);
    check(propagated, more, keypoints);
    FUZZ_CHECK(equal(alone.points2, propagated.points2) && equal(alone.covariances, propagated.covariances) &&
               equal(alone.similarities, propagated.similarities));
    checkAdded(more, matches.size(), propagated.similarities);
}
