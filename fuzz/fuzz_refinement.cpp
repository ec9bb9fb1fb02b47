// SPDX-License-Identifier: Apache-2.0

// refineMatches and propagateMatches with any images, keypoints and matches: a cv::Exception, or outputs of the documented
// shapes, where what is refused stays as it was.

#include "images.hpp"
#include "test_precomp.hpp"

#include <cmath>

namespace {

using namespace fuzz;
using namespace opencv_test;

std::vector<KeyPoint> takeKeyPoints(ByteSource& in, Size size)
{
    std::vector<KeyPoint> keypoints(in.between(0, 6));
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

void run(ByteSource& in)
{
    Mat images[2];
    std::vector<KeyPoint> keypoints[2];
    for (int i = 0; i < 2; i++)
    {
        const Size size = in.flag() ? Size(in.between(1, 99), in.between(1, 80)) : takeSize(in);
        images[i] = takeImage(in, size, in.rarely(32));
        keypoints[i] = takeKeyPoints(in, size);
    }
    if (in.flag())
        images[1] = images[0];
    useThreads(in.rarely(128) ? 3 : 1);
    std::vector<DMatch> matches(in.between(0, 8));
    bool valid = true;
    for (DMatch& m : matches)
    {
        m.queryIdx =
                in.rarely(32) ? in.between(-1, 9) : in.between(0, std::max((int)keypoints[0].size() - 1, 0));
        m.trainIdx =
                in.rarely(32) ? in.between(-1, 9) : in.between(0, std::max((int)keypoints[1].size() - 1, 0));
        valid = valid && m.queryIdx >= 0 && m.queryIdx < (int)keypoints[0].size() && m.trainIdx >= 0 &&
                m.trainIdx < (int)keypoints[1].size();
    }
    for (int i = 0; i < 2; i++)
        valid = valid && allValid(keypoints[i]) && !images[i].empty() && isImage(images[i]);
    Mat points1, points2, covariances, similarities;
    const bool thrown = refused([&] {
        refineMatches(images[0], keypoints[0], images[1], keypoints[1], matches, points1, points2,
                covariances, similarities);
    });
    FUZZ_CHECK(thrown == (!valid && !matches.empty()));
    if (thrown)
        return;
    const int n = (int)matches.size();
    FUZZ_CHECK(points1.rows == n && points2.rows == n && covariances.rows == n && similarities.rows == n);
    for (int i = 0; i < n; i++)
    {
        const Point2f first = keypoints[0][matches[i].queryIdx].pt,
                      second = keypoints[1][matches[i].trainIdx].pt;
        const Point2f found = points2.at<Point2f>(i);
        const float similarity = similarities.at<float>(i);
        FUZZ_CHECK(points1.at<Point2f>(i) == first);
        FUZZ_CHECK(similarity == -1 ? found == second : similarity > .5f && similarity <= 1);
        FUZZ_CHECK(covariances.at<float>(i, 0) >= 0 && covariances.at<float>(i, 2) >= 0 &&
                   checkRange(covariances));
    }
    std::vector<DMatch> more = matches;
    Mat first, second;
    propagateMatches(images[0], keypoints[0], images[1], keypoints[1], more, first, second);
    FUZZ_CHECK((int)more.size() >= n && first.rows == (int)more.size() && second.rows == first.rows);
    FUZZ_CHECK(n == 0 || cvtest::norm(points2, second.rowRange(0, n), NORM_INF) == 0);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uchar* data, size_t size) { return runTarget(run, data, size); }
