// SPDX-License-Identifier: Apache-2.0

#include "../uncertainty.hpp"
#include "opencv2/core/affine.hpp"
#include "opencv2/ts.hpp"

namespace {
using namespace iib_tools;

TEST(Uncertainty, errors_are_judged_by_their_covariance)
{
    const cv::Matx33d spread(2, 0, 0, 1, .5, 0, -3, 1, .1);
    const cv::Vec3d drawn(1, -2, 3);
    EXPECT_NEAR(drawn.dot(drawn), judged(spread * drawn, spread * spread.t()).squared, 1e-9);
    const JudgedError error = judged(cv::Vec2d(3, -4), cv::Matx22d(1, 0, 0, 4));
    EXPECT_NEAR(9 + 4, error.squared, 1e-12);
    EXPECT_NEAR(std::log(2) / 2, error.logDeviation, 1e-12);
    EXPECT_EQ(HUGE_VAL, judged(cv::Vec2d(1e-9, 2), cv::Matx22d(0, 0, 0, 1)).squared) << "reported as exact";
}

TEST(Uncertainty, scores_are_logarithms_of_a_density)
{
    double sum = 0;
    const double step = .1;
    for (double x = -30; x < 30; x += step)
        for (double y = -30; y < 30; y += step)
            sum += std::exp(judged(cv::Vec2d(x, y), cv::Matx22d(.3, .1, .1, .2)).score) * step * step;
    EXPECT_NEAR(sum, 1, 2e-3);
}

//! The vectors b and t x b of findRelativePose's documentation.
TEST(Uncertainty, directions_err_along_documented_axes)
{
    cv::RNG random(3);
    for (int trial = 0; trial < 100; trial++)
    {
        cv::Vec3d t, e;
        random.fill(t, cv::RNG::NORMAL, 0, 1);
        t = cv::normalize(t);
        int shortest = 0;
        for (int k = 0; k < 3; k++)
            if (std::abs(t[k]) < std::abs(t[shortest]))
                shortest = k;
        e[shortest] = 1;
        const cv::Vec3d b = cv::normalize(t.cross(e)), c = t.cross(b);
        const double angle = random.uniform(0., CV_PI), heading = random.uniform(0., 2 * CV_PI);
        const cv::Vec2d expected(angle * std::cos(heading), angle * std::sin(heading));
        const cv::Vec3d truth =
                std::cos(angle) * t + std::sin(angle) * (std::cos(heading) * b + std::sin(heading) * c);
        EXPECT_LT(cv::norm(alongTangents(t, truth) - expected), 1e-9) << angle;
        EXPECT_LT(cv::norm(alongTangents(t, t)), 1e-12);
        EXPECT_NEAR(CV_PI, cv::norm(alongTangents(t, -t)), 1e-6) << "the other way";
    }
}

TEST(Uncertainty, rectified_cameras_see_points_in_one_row)
{
    cv::RNG random(4);
    for (double side : {-1., 1.})
        for (int trial = 0; trial < 20; trial++)
        {
            cv::Vec3d turned, X;
            random.fill(turned, cv::RNG::UNIFORM, -.3, .3);
            random.fill(X, cv::RNG::UNIFORM, 4, 8);
            const cv::Matx33d R = cv::Affine3d(turned).rotation();
            const double z = random.uniform(-.4, .4), y = random.uniform(-.4, .4);
            const cv::Vec3d t(side, y, z);
            const Rectification turns = rectificationOf(R, t);
            for (const cv::Matx33d& turn : {turns.first, turns.second})
                EXPECT_LT(
                        cv::norm(turn * turn.t() - cv::Matx33d::eye()) + std::abs(cv::determinant(turn) - 1),
                        1e-12);
            EXPECT_LT(cv::norm(turns.first * X + cv::norm(t) * turns.t - turns.second * (R * X + t)), 1e-12);
            EXPECT_EQ(cv::Vec3d(side, 0, 0), turns.t);
            EXPECT_GT((turns.first * cv::Vec3d(0, 0, 1))[2], .8) << "still ahead";
        }
}

}  // namespace
