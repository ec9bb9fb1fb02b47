// SPDX-License-Identifier: Apache-2.0

#include "common/points.hpp"
#include "verdict/verdict.hpp"
#include "../pose/two_cameras.hpp"

namespace opencv_test { namespace {
using namespace cv::iib;

TEST(Verdict, false_alarms_are_few_of_right_matches_and_many_of_wrong_ones)
{
    RNG random(11);
    const Views right(random, randomPose(random, .1), 60, 0, 0),
            wrong(random, randomPose(random, .1), 60, 60, 0);
    Mat some(60, 1, CV_8U, Scalar(0)), none = some.clone();
    some.rowRange(0, 30) = 1;
    EXPECT_LT(logFalseAlarms(right.points1, right.points2, some, true, 1), -20);
    EXPECT_LT(logFalseAlarms(right.points1, right.points2, some, false, 1), -20);
    none.rowRange(0, 8) = 1;  // about as many of 60 random matches are near epipolar lines by chance
    EXPECT_GT(logFalseAlarms(wrong.points1, wrong.points2, none, true, 1), -3);
    none.rowRange(4, 8) = 0;
    EXPECT_TRUE(cvIsInf(logFalseAlarms(wrong.points1, wrong.points2, none, false, 1)));
    // Thirty matches in one place count as one.
    Points beside = right.points1;
    std::fill(beside.begin(), beside.begin() + 30, Point2d(100, 100));
    EXPECT_TRUE(cvIsInf(logFalseAlarms(beside, right.points2, some, true, 1)));
    EXPECT_THROW(logFalseAlarms(beside, right.points2, Mat(59, 1, CV_8U), true, 1), cv::Exception);
    EXPECT_THROW(logFalseAlarms(beside, right.points2, Mat(60, 1, CV_32S), true, 1), cv::Exception);
    EXPECT_THROW(logFalseAlarms(beside, right.points2, some, true, 0), cv::Exception);
    EXPECT_THROW(logFalseAlarms(Points(59), right.points2, some, true, 1), cv::Exception);
}

const Matx33d SMALL(80, 0, 40, 0, 80, 30, 0, 0, 1), LARGE(4000, 0, 2000, 0, 4000, 1500, 0, 0, 1);

//! Random points, four fifths of them near one line.
Points skyline(RNG& random, int count, double height)
{
    Points points = anywhere(random, count, 640, 480);
    for (int i = 0; i < count * 4 / 5; i++)
        points[i].y = 240 + random.gaussian(height);
    return points;
}

//! Projects to camera 2 the points at camera 1's pixels, at depths of 4 to 12 lengths of t. @param noise pixels
Points seenAgain(RNG& random, const Points& pixels, const Matx33d& K1, const Matx33d& K2,
        const RelativePose& pose, double noise)
{
    Points seen;
    for (const Point2d& p : pixels)
    {
        const Vec3d X = random.uniform(4., 12.) * (K1.inv() * Vec3d(p.x, p.y, 1)),
                    b = K2 * (pose.R * X + pose.t);
        const double x = b[0] / b[2] + random.gaussian(noise);
        seen.emplace_back(x, b[1] / b[2] + random.gaussian(noise));
    }
    return seen;
}

// The same scenes as those of the wrong matches below.
TEST(Verdict, right_matches_of_a_skyline_a_small_image_and_a_wide_scale_have_a_pose)
{
    const RelativePose pose = cv::iib::moved({Matx33d::eye(), Vec3d(.6, .8, 0)}, {.02, .03, .01, 0, 0});
    RNG random(17);
    for (int count : {20, 50, 100, 400})
    {
        const Points a = anywhere(random, count, 640, 480);
        EXPECT_TRUE(PoseResult(a, seenAgain(random, a, CAMERA, CAMERA, pose, .2)).found) << count;
    }
    for (int count : {100, 400})
        for (double height : {2., 5.})
        {
            const Points a = skyline(random, count, height),
                         b = seenAgain(random, a, CAMERA, CAMERA, pose, .2);
            const Mat agree(count, 1, CV_8U, Scalar(1));
            EXPECT_TRUE(PoseResult(a, b).found) << count << ' ' << height;
            EXPECT_LT(logFalseAlarms(a, b, agree, true, 1.5), -3) << count << ' ' << height;
        }
    for (int count : {200, 400})
    {
        const Points a = anywhere(random, count, 80, 60), b = seenAgain(random, a, SMALL, LARGE, pose, .2);
        EXPECT_TRUE(PoseResult(a, b, 0, SMALL, LARGE).found) << count;
        EXPECT_TRUE(PoseResult(b, a, 0, LARGE, SMALL).found) << count;
    }
    for (double scale : {5., 20., 30.})
    {
        const Points a = anywhere(random, 300, 640, 480), b = seenAgain(random, a, CAMERA, CAMERA, pose, 3);
        EXPECT_TRUE(PoseResult(a, b, scale).found) << scale;
    }
}

/* Sampson's error is small if the distance is small in either image. In crowded areas, more wrong matches agree with a pose than if points were
uniformly distributed. */
TEST(Verdict, wrong_matches_have_no_pose_in_any_images_at_any_scale)
{
    RNG random(17);
    const Size vga(640, 480), strip(640, 8);
    const struct
    {
        Size first, second;
        Matx33d camera1, camera2;
        std::vector<int> counts;
        std::vector<double> scales;
    } cases[] = {{vga, vga, CAMERA, CAMERA, {5, 6, 10, 20, 50, 100, 300}, {0, 0, 0}},
            {vga, vga, CAMERA, CAMERA, {30, 300}, {5, 20, 30, 200}},
            {strip, strip, CAMERA, CAMERA, {100, 400}, {0, 0}},
            {{80, 60}, {4000, 3000}, SMALL, LARGE, {200, 400}, {0}},
            {{4000, 3000}, {80, 60}, LARGE, SMALL, {200, 400}, {0}}};
    for (const auto& c : cases)
        for (int count : c.counts)
            for (double scale : c.scales)
            {
                const Points first = anywhere(random, count, c.first.width, c.first.height);
                const PoseResult result(first, anywhere(random, count, c.second.width, c.second.height),
                        scale, c.camera1, c.camera2);
                EXPECT_FALSE(result.found) << c.first << count << ' ' << scale;
                EXPECT_FALSE(result.reason.empty());
                EXPECT_EQ(count, result.inliers.rows);
            }
    for (int count : {100, 400})
        for (double height : {2., 5.})
        {
            const Points first = skyline(random, count, height), second = skyline(random, count, height);
            EXPECT_FALSE(PoseResult(first, second).found) << count;
            Mat agree(count, 1, CV_8U, Scalar(1));
            findFundamentalMat(first, second, USAC_MAGSAC, 1.5, .9999, 10000, agree);
            EXPECT_GT(logFalseAlarms(first, second, agree, true, 1.5), -3) << count;
        }
    const Points second = anywhere(random, 300, 640, 480), first = anywhere(random, 300, 640, 480);
    EXPECT_GT(logFalseAlarms(first, second, Mat::ones(300, 1, CV_8U), true, 1e4), 0);
}

TEST(Verdict, the_span_of_points_excludes_the_outermost)
{
    Points points;
    for (int i = 0; i < 100; i++)
        points.emplace_back(i, i == 50 ? 1e6 : i);
    EXPECT_LT(spanOf(points).height, 100);
    EXPECT_GT(spanOf(points).width, 90);
}

// Ten limits give ten times as many false alarms.
TEST(Verdict, limits_that_are_tried_count)
{
    RNG random(21);
    const Points a = anywhere(random, 60, 640, 480), b = anywhere(random, 60, 640, 480);
    const Verdict verdict(a, b);
    const std::vector<double> squared(60, .01), wrong(1000, 1e4);
    double best = 0;
    const double once = verdict.logFalseAlarms(squared, wrong, Verdict::FROM_LINE, 5, {1.}),
                 often = verdict.logFalseAlarms(
                         squared, wrong, Verdict::FROM_LINE, 5, std::vector<double>(10, 1.), &best);
    EXPECT_NEAR(once + 1, often, 1e-9);
    EXPECT_EQ(1, best);
}

// If none of a thousand wrong matches is within the limit, the chance is that of one in a thousand and one.
TEST(Verdict, the_chance_is_positive_without_a_wrong_match_within_the_limit)
{
    RNG random(22);
    const Verdict verdict(anywhere(random, 60, 640, 480), anywhere(random, 60, 640, 480));
    const std::vector<double> wrong(1000, 1e4);
    EXPECT_NEAR(1 / 1001., verdict.chance(Verdict::FROM_POINT, .01, wrong), 1e-12);
    EXPECT_NEAR(2 * 800 / (640 * 480.), verdict.chance(Verdict::FROM_LINE, 1, wrong), .001) << "of any line";
}

// In a place with many wrong matches, one of them often agrees by chance. All right matches are in one other place.
TEST(Verdict, a_place_of_many_matches_agrees_with_a_higher_chance)
{
    RNG random(20);
    const int wrong = 6000, right = 3000;
    const double chance = .05;
    Points points[2];
    Verdict::Marks all(wrong + right, true), agreeing(wrong + right);
    for (Points& image : points)
    {
        image = anywhere(random, wrong, 640, 480);
        image.resize(wrong + right, Point2d(100, 100));
    }
    for (int i = 0; i < wrong + right; i++)
        agreeing[i] = i >= wrong || random.uniform(0., 1.) < chance;
    EXPECT_GT(Verdict(points[0], points[1]).logFalseAlarms(all, agreeing, 5, chance), -3);
    // Four times as many are significant.
    for (int i = 0; i < wrong; i++)
        agreeing[i] = random.uniform(0., 1.) < 4 * chance;
    EXPECT_LT(Verdict(points[0], points[1]).logFalseAlarms(all, agreeing, 5, chance), -3);
}

TEST(Verdict, confidence_limits_are_those_of_students_t)
{
    RNG random(5);
    for (int dimensions : {1, 2, 3, 5})
        for (double probability : {.5, .95})
        {
            const double limit = confidenceLimit(probability, dimensions);
            const int trials = 20000;
            int inside = 0;
            for (int trial = 0; trial < trials; trial++)
            {
                double squared = 0, freedom = 0;
                for (int k = 0; k < dimensions; k++)
                    squared += std::pow(random.gaussian(.5), 2);
                for (int k = 0; k < 2; k++)
                    freedom += std::pow(random.gaussian(1), 2) / 2;
                inside += squared / freedom < limit;
            }
            EXPECT_NEAR((double)inside / trials, probability, .015) << dimensions;
        }
    EXPECT_EQ(confidenceLimit(0, 3), 0);
    EXPECT_THROW(confidenceLimit(1, 3), cv::Exception);
    EXPECT_THROW(confidenceLimit(-.1, 3), cv::Exception);
    EXPECT_THROW(confidenceLimit(std::numeric_limits<double>::quiet_NaN(), 3), cv::Exception);
    EXPECT_THROW(confidenceLimit(.5, 0), cv::Exception);
}

}}  // namespace opencv_test
