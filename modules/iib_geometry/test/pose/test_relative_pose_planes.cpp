// SPDX-License-Identifier: Apache-2.0

#include "two_cameras.hpp"

// Degenerate cases: planes, lines, and cameras that hardly moved.
namespace opencv_test { namespace {
using namespace cv::iib;

//! A point of a line; rotation about that line is undetermined.
Vec3d onLine(RNG& random)
{
    const double u = random.uniform(-1., 1.);
    return {2 * u, .5 + .7 * u, 7 + 2 * u};
}

// The baseline is a thousandth of the depth: noise of .03 pixels reveals it, noise of 1 pixel hides it.
TEST(RelativePose, points_in_front_tell_the_sign_of_t)
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
                const Views views(random, truth, 200, wrong, noise, .005);
                RelativePose pose;
                Mat covariance;
                if (!findRelativePose(views.points1, views.points2, CAMERA, CAMERA, pose.R, pose.t, noArray(),
                            0, covariance))
                    continue;
                found++;
                if (cv::trace(covariance(Rect(3, 3, 2, 2)))[0] > .25)
                    continue;
                certain++;
                behind += pose.t.dot(truth.t) < 0;
            }
            EXPECT_EQ(trials, found) << noise << ' ' << wrong;
            EXPECT_EQ(0, behind) << noise << ' ' << wrong;
            EXPECT_GE(certain, noise >= 1 ? 0 : wrong ? 5 : 25) << wrong;
        }
}

// Noise may put points that are far away behind a camera.
TEST(RelativePose, matches_of_a_camera_that_turned_agree)
{
    RNG random(31);
    for (double noise : {.1, 1., 3.})
        for (int trial = 0; trial < 5; trial++)
        {
            const Views views(random, randomPose(random, .1), 200, 0, noise, 0);
            Mat R, t, inliers, covariance;
            ASSERT_TRUE(findRelativePose(
                    views.points1, views.points2, CAMERA, CAMERA, R, t, inliers, 0, covariance));
            EXPECT_GE(countNonZero(inliers), 170) << noise;
            EXPECT_GT(cv::trace(covariance(Rect(3, 3, 2, 2)))[0], 1) << noise;
        }
}

//! Of matches whose direction of t, or more, nothing tells.
TEST(RelativePose, what_nothing_tells_has_a_large_deviation)
{
    const char* const cases[] = {"far points", "hardly any baseline", "points on a line", "identical images"};
    for (int kind = 0; kind < 4; kind++)
    {
        RNG random(20 + kind);
        for (int trial = 0; trial < 10; trial++)
        {
            const RelativePose truth =
                    kind == 3 ? RelativePose{Matx33d::eye(), Vec3d(1, 0, 0)} : randomPose(random, .1);
            Mat first(200, 2, CV_64F), second(200, 2, CV_64F);
            for (int i = 0; i < 200; i++)
            {
                const double baselines[] = {1e-6, 1e-3, 1, 0};
                double *const seen = first.ptr<double>(i), *const seenAgain = second.ptr<double>(i);
                see(random, truth, kind == 2 ? onLine(random) : anyPoint(random), kind == 3 ? 0 : .2, seen,
                        seenAgain, baselines[kind]);
                if (kind == 3 && i < 60)
                    std::copy_n(anyPixel(random).val, 2, seenAgain);
            }
            Mat R, t, inliers, covariance;
            String reason;
            if (!findRelativePose(first, second, CAMERA, CAMERA, R, t, inliers, 0, covariance, &reason))
            {
                EXPECT_EQ(2, kind) << reason;  // points on a line lie on a plane, too
                EXPECT_NE(reason.find("two poses"), String::npos) << reason;
                continue;
            }
            EXPECT_GE(countNonZero(inliers), 130) << cases[kind];
            Vec2d values;
            eigen(Matx22d(covariance(Rect(3, 3, 2, 2))), values);
            EXPECT_GT(std::sqrt(values[0]), 1) << cases[kind];
        }
    }
}

TEST(RelativePose, covariances_have_an_inverse)
{
    RNG random(21);
    int found = 0;
    for (int trial = 0; trial < 10; trial++)
    {
        const RelativePose truth = randomPose(random, .1);
        Mat first(200, 2, CV_64F), second(200, 2, CV_64F), R, t, covariance, values;
        for (int i = 0; i < first.rows; i++)
            see(random, truth, onLine(random), .2, first.ptr<double>(i), second.ptr<double>(i));
        if (!findRelativePose(first, second, Mat(CAMERA), Mat(CAMERA), R, t, noArray(), 0, covariance))
            continue;
        found++;
        eigen(covariance, values);
        EXPECT_GT(values.at<double>(4), 0);
        EXPECT_GT(values.at<double>(0), 1) << "a rotation that nothing tells";
    }
    EXPECT_GE(found, 1);
}

//! What became of poses of a plane, or of points about it.
struct OfPlane
{
    int right = 0, wrong = 0, beyond = 0, refused = 0;  //!< beyond: by five deviations and more

    /** @param relief by which part of their distance points are before or behind the plane
    @param wrongMatches how many of them are anywhere */
    OfPlane(int trials, int count, double relief, double noise = .2, int wrongMatches = 0)
    {
        for (int trial = 0; trial < trials; trial++)
        {
            RNG random(100 + trial);
            const RelativePose truth = randomPose(random, .1);
            Mat first(count, 2, CV_64F), second(count, 2, CV_64F), covariance;
            for (int i = 0; i < count; i++)
            {
                const Vec3d ray = CAMERA.inv() * anyPixel(random);
                const double aside = relief > 0 ? random.uniform(-relief, relief) : 0;
                const Vec3d X = ray * (8 * (1 + aside) / (1 + .2 * ray[0] + .1 * ray[1]));
                see(random, truth, X, noise, first.ptr<double>(i), second.ptr<double>(i));
            }
            for (Mat* points : {&first, &second})
                if (wrongMatches > 0)
                    anywhere(random, wrongMatches, 640, 480).copyTo(points->rowRange(0, wrongMatches));
            RelativePose pose;
            String reason;
            if (!findRelativePose(
                        first, second, CAMERA, CAMERA, pose.R, pose.t, noArray(), 0, covariance, &reason))
            {
                refused++;
                EXPECT_NE(reason.find("plane"), String::npos) << reason;
                continue;
            }
            const Vec<double, 5> error = stepBetween(pose, truth);
            (cv::norm(error) < .1 ? right : wrong)++;
            beyond += error.dot(Matx<double, 5, 5>(covariance).inv() * error) > 25;
        }
    }
};

//! Two poses explain a plane. Where nothing but chance decides between them there is no pose.
TEST(RelativePose, of_a_plane_is_right_or_refused)
{
    for (int count : {200, 800})
    {
        const OfPlane poses(30, count, 0);
        EXPECT_GE(poses.right, 15) << count;
        EXPECT_GE(poses.refused, 10) << count;
        EXPECT_LE(poses.wrong, count == 200 ? 1 : 3) << count;  // told, as two poses that differ little
        EXPECT_EQ(0, poses.beyond) << count;
    }
    const OfPlane few(60, 30, 0);
    EXPECT_GE(few.right, 25);
    EXPECT_LE(few.wrong, 3);
    EXPECT_EQ(0, few.beyond) << "the second pose was looked for";
}

// Noise decides between the two poses more often than chance has it, if it is judged by its deviation alone.
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
