// SPDX-License-Identifier: Apache-2.0

#include "pose/pose_fit.hpp"
#include "two_cameras.hpp"
#include "verdict/pose_tests.hpp"

// Which poses are accepted, and their estimated errors.
namespace opencv_test { namespace {
using namespace cv::iib;

RelativePose along(RNG& random, const Vec3d& t) { return {randomPose(random, .1).R, normalize(t)}; }

void append(Views& views, const Point2d& first, const Point2d& second)
{
    views.points1.push_back(first);
    views.points2.push_back(second);
}

//! The camera moves forward by .1, points are 4 to 12 away. Noise near the epipole must not hide the direction of t.
TEST(RelativePose, a_short_move_forward_has_a_direction_and_a_rotation_has_none)
{
    const auto deviation = [](const PoseResult& result) {
        EXPECT_TRUE(result.found) << result.reason;
        return std::sqrt(cv::trace(result.ofDirection()));
    };
    RNG random(63);
    int moves = 0, turns = 0;
    for (int trial = 0; trial < 10; trial++)
    {
        const RelativePose truth = along(random, Vec3d(0, 0, 1));
        const PoseResult move(Views(random, truth, 1000, 0, .5, .1)),
                turn(Views(random, truth, 200, 0, .5, 0));
        moves += deviation(move) < .25 && move.hasDirection(truth);
        turns += deviation(turn) > 1;
    }
    EXPECT_GE(moves, 8);
    EXPECT_GE(turns, 9);
}

TEST(RelativePose, captions_among_random_matches_are_refused)
{
    RNG random(61);
    for (int captions : {1, 2, 3})
        for (int trial = 0; trial < 10; trial++)
        {
            Views views(random, randomPose(random, .2), 240, 240, 0);
            for (int caption = 0; caption < captions; caption++)
            {
                const Point2d corner(random.uniform(20., 400.), random.uniform(20., 420.)),
                        shift(random.uniform(-15., 15.), random.uniform(-15., 15.));
                for (int i = 0; i < (captions == 1 ? 60 : 30); i++)
                {
                    const Point2d p = corner + Point2d(random.uniform(0., 200.), random.uniform(0., 30.));
                    append(views, p, p + shift + Point2d(random.gaussian(.1), random.gaussian(.1)));
                }
            }
            const PoseResult result(views);
            EXPECT_FALSE(result.found) << captions << ' ' << trial;
            EXPECT_FALSE(result.reason.empty());
        }
}

TEST(RelativePose, more_right_matches_never_lose_the_pose)
{
    const struct
    {
        int count;
        double beside;  // pixels
    } scenes[] = {{0, 0}, {40, 0}, {200, 10}};
    for (const auto& scene : scenes)
    {
        RNG random(62);
        for (int trial = 0; trial < 15; trial++)
        {
            const RelativePose truth = randomPose(random, .2);
            Views views(random, truth, 12, 0, 0);
            const Vec3d centre(random.uniform(100., 540.), random.uniform(100., 380.), 1);
            const double depth = random.uniform(6., 12.);
            for (int i = 0; i < scene.count; i++)
            {
                const Vec3d pixel =
                        centre + scene.beside * Vec3d(random.uniform(-1., 1.), random.uniform(-1., 1.), 0);
                Point2d first, second;
                see(random, truth, depth * (CAMERA.inv() * pixel), 0, first, second);
                append(views, first, second);
            }
            const PoseResult result(views);
            EXPECT_TRUE(result.found) << scene.count << ' ' << scene.beside << ": " << result.reason;
        }
    }
}

TEST(RelativePose, eight_right_matches_are_enough_and_eight_wrong_ones_are_not)
{
    RNG random(63);
    int right = 0, wrong = 0;
    for (int trial = 0; trial < 40; trial++)
    {
        right += PoseResult(Views(random, randomPose(random, .2), 8, 0, .1)).found;
        wrong += PoseResult(Views(random, randomPose(random, .2), 8, 8, 0)).found;
    }
    EXPECT_GE(right, 28);
    EXPECT_EQ(0, wrong);
}

TEST(RelativePose, of_swapped_images_is_the_inverse)
{
    RNG random(64);
    for (int trial = 0; trial < 10; trial++)
    {
        Views views(random, randomPose(random, .2), 60, 30, .5);
        const PoseResult one(views);
        std::swap(views.points1, views.points2);
        const PoseResult other(views);
        ASSERT_EQ(one.found, other.found);
        EXPECT_EQ(one.reason, other.reason);
        if (!one.found)
            continue;
        EXPECT_LT(cv::norm(stepBetween(inverse(one.pose), other.pose)), 1e-9);
        const Matx<double, 5, 5> back = stepOfInverse(one.pose);
        EXPECT_LT(cv::norm(back * one.covariance * back.t(), other.covariance),
                1e-6 * cv::norm(other.covariance));
    }
}

TEST(RelativePose, a_step_from_it_is_a_step_from_its_inverse)
{
    RNG random(65);
    const RelativePose pose = randomPose(random, 1);
    const Matx<double, 5, 5> all = stepOfInverse(pose);
    for (int k = 0; k < 5; k++)
    {
        Vec<double, 5> step;
        step[k] = 1e-3;
        const Vec<double, 5> there = stepBetween(inverse(pose), inverse(moved(pose, step)));
        EXPECT_LT(cv::norm(there - all * step), 1e-5) << k;
    }
}

// The fit must leave out wrong matches with the parallax of no right one: they would make the estimated errors too small.
TEST(RelativePose, errors_of_small_parallax_are_realistic_among_wrong_matches)
{
    const struct
    {
        Vec3d t;
        int trials, count, wrong, inside;
    } scenes[] = {{Vec3d(.01, .02, -1), 50, 200, 100, 46}, {Vec3d(.01, .02, 1), 50, 200, 100, 46},
            {Vec3d(1, .2, .1), 50, 200, 100, 46}, {Vec3d(1, .5, .5), 20, 1000, 850, 17}};
    for (const auto& scene : scenes)
    {
        RNG random(66);
        int inside = 0;
        for (int trial = 0; trial < scene.trials; trial++)
        {
            const RelativePose truth = along(random, scene.t);
            const PoseResult result(Views(random, truth, scene.count, scene.wrong, .5, .3));
            inside += result.found && result.hasDirection(truth);
        }
        EXPECT_GE(inside, scene.inside) << scene.t;
    }
}

TEST(RelativePose, a_match_of_unusual_parallax_is_left_out)
{
    std::vector<double> squared(100, .01), parallaxes(100, 10);
    for (int i = 50; i < 100; i++)  // fifty wrong matches; one is within the limit
    {
        squared[i] = i == 50 ? .01 : 1e4;
        parallaxes[i] = 200;
    }
    const Verdict::Marks marks = withinByMoreThanChance(squared, parallaxes, 1);
    EXPECT_EQ(50, std::count(marks.begin(), marks.end(), true));
    EXPECT_FALSE(marks[50]);
    parallaxes.assign(100, 10);
    EXPECT_TRUE(withinByMoreThanChance(squared, parallaxes, 1)[50]);
}

// Displaced by 20 pixels, matches are still nearer to the epipolar lines of many poses than wrong matches are.
TEST(RelativePose, matches_displaced_at_random_have_no_pose_and_inexact_ones_have)
{
    RNG random(71);
    int displaced = 0, inexact = 0;
    for (int trial = 0; trial < 10; trial++)
    {
        const RelativePose truth = randomPose(random, .1);
        displaced += PoseResult(Views(random, truth, 200, 0, 20)).found;
        inexact += PoseResult(Views(random, truth, 200, 50, 3)).found;
    }
    EXPECT_EQ(0, displaced);
    EXPECT_GE(inexact, 9);
}

// 49 of 350 matches are right; less than one sample in ten thousand is free of wrong matches.
TEST(RelativePose, is_found_by_few_right_matches_within_half_a_pixel)
{
    RNG random(69);
    int right = 0, quick = 0;
    for (int trial = 0; trial < 20; trial++)
    {
        const RelativePose truth = randomPose(random, .2);
        const Views views(random, truth, 350, 301, .25);
        const PoseResult result(views);
        right += result.found && cv::norm(result.error(truth)) < .05;
        const EpipolarProblem problem(views.points1, views.points2, CAMERA, CAMERA);
        quick += fitPose(problem, Verdict(views.points1, views.points2), 0, {}).samples < 5000;
    }
    EXPECT_GE(right, 14);
    EXPECT_GE(quick, 14);  // by samples of matches that move like their neighbours; others are 12,000
}

TEST(RelativePose, takes_covariances_of_matches)
{
    RNG random(70);
    const RelativePose truth = randomPose(random, .2);
    const Views views(random, truth, 100, 30, .2);
    RelativePose pose;
    const auto find = [&](const Mat& covariances) {
        return findRelativePose(views.points1, views.points2, CAMERA, CAMERA, pose.R, pose.t, noArray(), 0,
                noArray(), nullptr, covariances);
    };
    ASSERT_TRUE(find(Mat(100, 3, CV_32F, Scalar(.04))));
    EXPECT_LT(cv::norm(stepBetween(pose, truth)), .03);
    EXPECT_THROW(find(Mat(99, 3, CV_32F, Scalar(.04))), cv::Exception);
    EXPECT_THROW(find(Mat(100, 3, CV_32S, Scalar(1))), cv::Exception);
}

}}  // namespace opencv_test
