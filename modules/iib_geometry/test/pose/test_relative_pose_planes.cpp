// SPDX-License-Identifier: Apache-2.0

#include "two_cameras.hpp"

// Poses that matches do not determine: of planes, of lines, and of cameras that hardly moved.
namespace opencv_test { namespace {
using namespace cv::iib;

//! A point on a line. Such points do not determine the rotation about the line.
Vec3d onLine(RNG& random)
{
    const double u = random.uniform(-1., 1.);
    return {2 * u, .5 + .7 * u, 7 + 2 * u};
}

// The baseline is a thousandth of the depth: noise of .03 pixels leaves the direction of t visible, noise of a pixel does not.
TEST(RelativePose, points_in_front_determine_the_sign_of_t)
{
    for (double noise : {.03, 1.})
        for (int wrong : {0, 40})
        {
            RNG random(7);
            int found = 0, certain = 0, behind = 0;
            const int trials = 50;
            for (int trial = 0; trial < trials; trial++)
            {
                const RelativePose truth = randomPose(random, .1);
                const PoseResult result(Views(random, truth, 200, wrong, noise, .005));
                const bool isCertain = result.found && cv::trace(result.ofDirection()) <= .25;
                found += result.found;
                certain += isCertain;
                behind += isCertain && result.pose.t.dot(truth.t) < 0;
            }
            EXPECT_EQ(trials, found) << noise << ' ' << wrong;
            EXPECT_EQ(0, behind) << noise << ' ' << wrong;
            EXPECT_GE(certain, noise >= 1 ? 0 : wrong ? 5 : 25) << wrong;
        }
}

// By noise, distant points may seem to be behind a camera.
TEST(RelativePose, matches_of_a_rotated_camera_are_inliers)
{
    RNG random(31);
    for (double noise : {.1, 1., 3.})
        for (int trial = 0; trial < 5; trial++)
        {
            const PoseResult result(Views(random, randomPose(random, .1), 200, 0, noise, 0));
            ASSERT_TRUE(result.found) << result.reason;
            EXPECT_GE(countNonZero(result.inliers), 170) << noise;
            EXPECT_GT(cv::trace(result.ofDirection()), 1) << noise;
        }
}

//! The matches do not determine the direction of t, or even less.
TEST(RelativePose, undetermined_parameters_have_a_large_deviation)
{
    const char* const cases[] = {"far points", "hardly any baseline", "points on a line", "identical images"};
    for (int kind = 0; kind < 4; kind++)
    {
        RNG random(20 + kind);
        int found = 0;
        for (int trial = 0; trial < 10; trial++)
        {
            const RelativePose truth =
                    kind == 3 ? RelativePose{Matx33d::eye(), Vec3d(1, 0, 0)} : randomPose(random, .1);
            Points first(200), second(200);
            for (int i = 0; i < 200; i++)
            {
                const double baselines[] = {1e-6, 1e-3, 1, 0};
                see(random, truth, kind == 2 ? onLine(random) : anyPoint(random), kind == 3 ? 0 : .2,
                        first[i], second[i], baselines[kind]);
                if (kind == 3 && i < 60)
                    second[i] = anywhere(random, 1, 640, 480)[0];
            }
            const PoseResult result(first, second);
            if (!result.found)
            {
                EXPECT_EQ(2, kind) << result.reason;  // points on a line are also on a plane
                EXPECT_NE(result.reason.find("two poses"), String::npos) << result.reason;
                continue;
            }
            found++;
            EXPECT_GE(countNonZero(result.inliers), 130) << cases[kind];
            Vec2d values;
            eigen(result.ofDirection(), values);
            EXPECT_GT(std::sqrt(values[0]), 1) << cases[kind];
            Vec<double, 5> all;
            eigen(result.covariance, all);
            EXPECT_GT(all[4], 0) << "has an inverse";
        }
        EXPECT_GE(found, 1) << cases[kind];
    }
}

//! Counts the results for points on a plane or near it.
struct OfPlane
{
    int right = 0, wrong = 0, refused = 0;
    int beyond = 0;  //!< errors of five standard deviations or more

    /** @param relief largest distance of points from the plane, as a share of their depth
    @param wrongMatches number of matches with random points */
    OfPlane(int trials, int count, double relief, double noise = .2, int wrongMatches = 0)
    {
        for (int trial = 0; trial < trials; trial++)
        {
            RNG random(100 + trial);
            const RelativePose truth = randomPose(random, .1);
            Points first(count), second(count);
            for (int i = 0; i < count; i++)
            {
                const Vec3d ray = CAMERA.inv() * anyPixel(random);
                const double aside = relief > 0 ? random.uniform(-relief, relief) : 0;
                const Vec3d X = ray * (8 * (1 + aside) / (1 + .2 * ray[0] + .1 * ray[1]));
                see(random, truth, X, noise, first[i], second[i]);
            }
            for (Points* points : {&first, &second})
            {
                const Points others = anywhere(random, wrongMatches, 640, 480);
                std::copy(others.begin(), others.end(), points->begin());
            }
            const PoseResult result(first, second);
            (!result.found ? refused : cv::norm(result.error(truth)) < .1 ? right : wrong)++;
            beyond += result.found && result.squared(truth) > 25;
            EXPECT_TRUE(result.found || result.reason.find("plane") != String::npos) << result.reason;
        }
    }
};

//! Two poses explain a plane. If both explain the matches equally well, there is no pose.
TEST(RelativePose, of_a_plane_is_right_or_refused)
{
    for (int count : {200, 800})
    {
        const OfPlane poses(30, count, 0);
        EXPECT_GE(poses.right, 15) << count;
        EXPECT_GE(poses.refused, 10) << count;
        EXPECT_LE(poses.wrong, count == 200 ? 1 : 3)
                << count;  // within their covariance: two poses that differ little
        EXPECT_EQ(0, poses.beyond) << count;
    }
    const OfPlane few(60, 30, 0);
    EXPECT_GE(few.right, 25);
    EXPECT_LE(few.wrong, 3);
    EXPECT_EQ(0, few.beyond) << "the covariance includes the second pose";
}

// Noise often makes the wrong pose fit better, by more than its standard deviation suggests.
TEST(RelativePose, of_a_noisy_plane_is_seldom_beyond_its_errors)
{
    const OfPlane poses(40, 200, 0, 1.5, 100);
    EXPECT_GE(poses.right + poses.wrong, 15);
    EXPECT_LE(poses.beyond, 1);
}

TEST(RelativePose, of_points_about_a_plane_is_found)
{
    for (int count : {30, 200})
    {
        const OfPlane poses(20, count, .05);
        EXPECT_EQ(20, poses.right) << count;
    }
}

}}  // namespace opencv_test
