// SPDX-License-Identifier: Apache-2.0

#include "../uncertainty.hpp"
#include "opencv2/core/affine.hpp"
#include "opencv2/ts.hpp"

namespace {
using namespace iib_tools;

// Quantiles of chi^2 by scipy.stats.chi2.ppf.
TEST(Uncertainty, chances_are_those_of_chi_squared)
{
    const struct
    {
        double chance, two, three;
    } quantiles[] = {{.1, .2107210, .5843744}, {.5, 1.3862944, 2.3659739}, {.95, 5.9914645, 7.8147279},
            {.99, 9.2103404, 11.3448667}};
    for (const auto& q : quantiles)
    {
        EXPECT_NEAR(q.chance, chanceOf(q.two, 2), 1e-6);
        EXPECT_NEAR(q.chance, chanceOf(q.three, 3), 1e-6);
    }
    EXPECT_EQ(0, chanceOf(0, 2));
    EXPECT_EQ(0, chanceOf(0, 3));
    EXPECT_EQ(1, chanceOf(1e6, 3));
}

TEST(Uncertainty, errors_of_a_covariance_are_in_its_deviations)
{
    const cv::Matx33d spread(2, 0, 0, 1, .5, 0, -3, 1, .1);
    const cv::Vec3d drawn(1, -2, 3);
    EXPECT_NEAR(drawn.dot(drawn), squaredOf(spread * drawn, spread * spread.t()), 1e-9);
    EXPECT_NEAR(9 + 4, squaredOf(cv::Vec2d(3, -4), cv::Matx22d(1, 0, 0, 4)), 1e-12);
    EXPECT_EQ(HUGE_VAL, squaredOf(cv::Vec2d(1e-9, 2), cv::Matx22d(0, 0, 0, 1))) << "told as certain";
    EXPECT_EQ(4, squaredOf(cv::Vec2d(0, 2), cv::Matx22d(0, 0, 0, 1)));
    EXPECT_EQ(1, chanceOf(HUGE_VAL, 2));
    EXPECT_EQ(1, chanceOf(HUGE_VAL, 3));
}

//! As findRelativePose's documentation has b, t x b and the axis along which t is shortest.
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
