// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "../support/test_errors.hpp"
#include "../support/textures.hpp"
#include "refinement_scene.hpp"

#include <set>

namespace opencv_test { namespace {

//! A scene, and propagateMatches() of some of its matches.
class IIB_Propagation : public testing::Test
{
protected:
    static const RefinementScene& scene() { return RefinementScene::seven(); }

    static Refined propagate(const std::vector<DMatch>& matches, const Mat& second,
            const std::vector<KeyPoint>& keypoints1, const std::vector<KeyPoint>& keypoints2)
    {
        Refined r = {matches, Mat(), Mat(), Mat(), Mat()};
        propagateMatches(scene().images[0], keypoints1, second, keypoints2, r.matches, r.points1, r.points2,
                r.covariances, r.similarities);
        return r;
    }

    static Refined propagate(const std::vector<DMatch>& matches)
    {
        return propagate(matches, scene().images[1], scene().keypoints[0], scene().keypoints[1]);
    }

    //! Every n-th match.
    static std::vector<DMatch> some(int step)
    {
        std::vector<DMatch> matches;
        for (size_t i = 0; i < scene().matches.size(); i += step)
            matches.push_back(scene().matches[i]);
        return matches;
    }

    //! The matches nearest to the middle of the first image.
    static std::vector<DMatch> central(int count)
    {
        std::vector<DMatch> matches = scene().matches;
        const auto distance = [](const DMatch& m) {
            return cv::norm(scene().keypoints[0][m.queryIdx].pt - Point2f(320, 240));
        };
        std::sort(matches.begin(), matches.end(),
                [&](const DMatch& a, const DMatch& b) { return distance(a) < distance(b); });
        matches.resize(count);
        return matches;
    }
};

// Keypoint i of one image is keypoint i of the other one.
TEST_F(IIB_Propagation, finds_what_is_missing)
{
    for (const std::vector<DMatch>& given : {some(5), central(4)})
    {
        const Refined r = propagate(given);
        const int n = (int)r.matches.size();
        EXPECT_GT(n, .9 * scene().matches.size());
        std::set<int> first, second;
        int right = 0;
        for (int i = 0; i < n; i++)
        {
            const DMatch& m = r.matches[i];
            first.insert(m.queryIdx);
            second.insert(m.trainIdx);
            const Point2f from = scene().keypoints[0][m.queryIdx].pt;
            EXPECT_EQ(from, r.points1.at<Point2f>(i));
            right += cv::norm(Point2d(r.points2.at<Point2f>(i)) - scene().truth(from)) < .5;
            if (i < (int)given.size())
            {
                EXPECT_EQ(given[i].queryIdx, m.queryIdx);
                EXPECT_EQ(given[i].distance, m.distance);
            }
            else
            {
                EXPECT_EQ(std::numeric_limits<float>::max(), m.distance);
                EXPECT_GT(r.similarities.at<float>(i), .7);
            }
        }
        EXPECT_GT(right, .98 * n);
        EXPECT_EQ(r.matches.size(), first.size());
        EXPECT_EQ(r.matches.size(), second.size());
        for (const Mat& m : {r.points2, r.covariances, r.similarities})
            EXPECT_EQ(n, m.rows);
    }
}

// Exact start places.
TEST_F(IIB_Propagation, leads_on_in_identical_images)
{
    const std::vector<KeyPoint>& keypoints = scene().keypoints[0];
    Refined r = {some(5), Mat(), Mat(), Mat(), Mat()};
    propagateMatches(scene().images[0], keypoints, scene().images[0], keypoints, r.matches, r.points1,
            r.points2, r.covariances, r.similarities);
    EXPECT_GT(r.matches.size(), .95 * keypoints.size());
    EXPECT_EQ(0, cvtest::norm(r.points1, r.points2, NORM_INF));
}

TEST_F(IIB_Propagation, refines_the_given_matches_as_refineMatches_does)
{
    const std::vector<DMatch> given = some(5);
    expectSame(
            refine(scene().images[0], scene().keypoints[0], scene().images[1], scene().keypoints[1], given),
            propagate(given));
}

TEST_F(IIB_Propagation, only_matches_that_two_others_confirm_lead_on)
{
    EXPECT_EQ(2u, propagate(central(2)).matches.size());
    EXPECT_LT(3u, propagate(central(3)).matches.size());
    std::vector<DMatch> far = {central(1)[0]};
    for (const DMatch& m : scene().matches)
    {
        const auto isFar = [&](const DMatch& other) {
            return cv::norm(scene().keypoints[0][m.queryIdx].pt - scene().keypoints[0][other.queryIdx].pt) >
                   100;
        };
        if (std::all_of(far.begin(), far.end(), isFar))
            far.push_back(m);
    }
    EXPECT_LT(4u, far.size());
    EXPECT_EQ(far.size(), propagate(far).matches.size());
}

TEST_F(IIB_Propagation, wrong_matches_lead_nowhere)
{
    std::vector<DMatch> wrong = some(3);
    for (size_t i = 0; i < wrong.size(); i++)
        wrong[i].trainIdx = some(3)[(i + 7) % wrong.size()].trainIdx;
    EXPECT_EQ(wrong.size(), propagate(wrong).matches.size());
    const RefinementScene other(8);
    EXPECT_GE(some(3).size() + 2,
            propagate(some(3), other.images[1], scene().keypoints[0], scene().keypoints[1]).matches.size());
}

// Predictions use the rotation and scale of refined matches.
TEST_F(IIB_Propagation, follows_turned_and_scaled_surroundings)
{
    Mat turned;
    cv::rotate(scene().images[1], turned, ROTATE_90_CLOCKWISE);
    cv::resize(turned, turned, Size(), .75, .75, INTER_AREA);
    std::vector<KeyPoint> first = scene().keypoints[0], second = scene().keypoints[1];
    for (KeyPoint& kp : first)
        kp.angle = 20;
    for (KeyPoint& kp : second)
    {
        kp.pt = (Point2f(479 - kp.pt.y, kp.pt.x) + Point2f(.5f, .5f)) * .75f - Point2f(.5f, .5f);
        kp.size *= .75f;
        kp.angle = 110;
    }
    const std::vector<DMatch> given = some(5);
    const Refined r = propagate(given, turned, first, second);
    EXPECT_GT(r.matches.size(), .8 * scene().matches.size());
    int right = 0;
    for (size_t i = 0; i < r.matches.size(); i++)
        right += r.matches[i].queryIdx == r.matches[i].trainIdx;
    EXPECT_GT(right, .98 * r.matches.size());
}

// Two keypoints at each place of the second image, and strong noise.
TEST_F(IIB_Propagation, takes_a_keypoint_once_and_only_what_agrees_well)
{
    Mat noise(scene().images[1].size(), CV_16S), noisy;
    RNG(5).fill(noise, RNG::NORMAL, 0, 14);
    cv::add(scene().images[1], noise, noisy, noArray(), CV_8U);
    std::vector<KeyPoint> second = scene().keypoints[1];
    for (const KeyPoint& kp : scene().keypoints[1])
        second.push_back(KeyPoint(kp.pt + Point2f(.7f, -.4f), kp.size));
    const std::vector<DMatch> given = some(3);
    const Refined r = propagate(given, noisy, scene().keypoints[0], second);
    EXPECT_GT(r.matches.size(), given.size() + 10);
    EXPECT_LT(r.matches.size(), scene().matches.size());
    std::set<int> first;
    for (size_t i = 0; i < r.matches.size(); i++)
    {
        EXPECT_TRUE(first.insert(r.matches[i].queryIdx).second);
        EXPECT_GT(i < given.size() ? 1 : r.similarities.at<float>((int)i), .7);
    }
}

// Many keypoints at one place: quadratic work would take 40 seconds.
TEST_F(IIB_Propagation, many_keypoints_at_one_place_take_no_time)
{
    std::vector<KeyPoint> first = scene().keypoints[0], second = scene().keypoints[1];
    const Point2f centre = first[central(1)[0].queryIdx].pt;
    for (int i = 0; i < 32000; i++)
    {
        const Point2f place = centre + Point2f(i % 200 * .2f - 20, i / 200 * .25f - 20);
        first.push_back(KeyPoint(place, 8));
        second.push_back(KeyPoint(Point2f(scene().truth(place)), 8));
    }
    const int64 begin = getTickCount();
    const Refined r = propagate(central(20), scene().images[1], first, second);
    RecordProperty("seconds", format("%.1f", (getTickCount() - begin) / getTickFrequency()));
    EXPECT_GT(r.matches.size(), 500u);
}

TEST_F(IIB_Propagation, is_the_same_for_every_number_of_threads)
{
    forEveryNumberOfThreads([] { return propagate(some(5)); }, expectSame);
}

TEST_F(IIB_Propagation, takes_points_anywhere)
{
    std::vector<KeyPoint> first = scene().keypoints[0], second = scene().keypoints[1];
    for (const Point2f& place : {Point2f(1e30f, 2), Point2f(-3, -1e30f), Point2f(639, 479), Point2f(-1, 5)})
    {
        first.push_back(KeyPoint(place, 9));
        second.push_back(KeyPoint(place, 9));
    }
    std::vector<DMatch> given = some(5);
    given.push_back(DMatch((int)first.size() - 1, (int)second.size() - 4, 0));
    const Refined r = propagate(given, scene().images[1], first, second);
    EXPECT_EQ(propagate(some(5)).matches.size() + 1, r.matches.size());
}

TEST_F(IIB_Propagation, without_matches_all_is_empty_and_errors_say_what_is_wrong)
{
    const Refined r = propagate({}, Mat(), {}, {});
    for (const Mat& m : {r.points1, r.points2, r.covariances, r.similarities})
        EXPECT_TRUE(m.empty());
    expectError(Error::StsOutOfRange, "a match is of keypoint 1 of image 2, which has 1", [] {
        propagate({DMatch(0, 1, 0)}, scene().images[1], scene().keypoints[0], {KeyPoint(9, 9, 9)});
    });
}

}}  // namespace opencv_test
