// SPDX-License-Identifier: Apache-2.0

#include "derivatives.hpp"
#include "pose/epipolar_problem.hpp"
#include "pose/five_points.hpp"
#include "pose/real_roots.hpp"
#include "two_cameras.hpp"

namespace opencv_test {
namespace {
using namespace cv::iib;

//! The step from a pose that was found to the truth.
Vec<double, 5> errorOf(const RelativePose& pose, const RelativePose& truth)
{
    return stepBetween(pose, truth);
}

TEST(RelativePose, real_roots_are_found_inside_and_outside_of_the_unit_interval)
{
    const double wanted[] = {-7.5, -.9, -.25, 0, .3, .31, .8, 2, 40};
    double p[10] = {-1}, roots[9];  // their product, constant first
    for (int k = 0; k < 9; k++)
        for (int i = k + 1; i >= 0; i--)
            p[i] = (i ? p[i - 1] : 0) - wanted[k] * p[i];
    ASSERT_EQ(9, realRoots(p, 9, roots));
    std::sort(roots, roots + 9);
    for (int k = 0; k < 9; k++)
        EXPECT_NEAR(wanted[k], roots[k], 1e-6 * (1 + std::abs(wanted[k])));
    const double none[] = {1, 0, 3, 0, 1};
    EXPECT_EQ(0, realRoots(none, 4, roots));
}

TEST(RelativePose, five_points_give_essential_matrices_and_the_true_one_among_them)
{
    RNG random(1);
    int found = 0;
    for (int trial = 0; trial < 500; trial++)
    {
        const RelativePose truth = randomPose(random, .6);
        const Views views(random, truth, 5, 0, 0);
        Point2d first[5], second[5];
        for (int i = 0; i < 5; i++)
        {
            const Vec3d u = CAMERA.inv() *
                            Vec3d(views.points1.at<double>(i, 0), views.points1.at<double>(i, 1), 1),
                        v = CAMERA.inv() *
                            Vec3d(views.points2.at<double>(i, 0), views.points2.at<double>(i, 1), 1);
            first[i] = Point2d(u[0], u[1]);
            second[i] = Point2d(v[0], v[1]);
        }
        std::vector<Matx33d> essentials;
        fivePointEssentials(first, second, essentials);
        const Matx33d expected = essentialOf(truth) * (1 / std::sqrt(2.));
        double nearest = 1;
        for (const Matx33d& E : essentials)
        {
            for (int i = 0; i < 5; i++)
                EXPECT_NEAR(0, Vec3d(second[i].x, second[i].y, 1).dot(E * Vec3d(first[i].x, first[i].y, 1)),
                        1e-6);
            nearest = std::min({nearest, cv::norm(E - expected), cv::norm(E + expected)});
        }
        found += nearest < 1e-4;
    }
    EXPECT_GE(found, 490);
}

TEST(RelativePose, the_four_poses_of_an_essential_matrix_hold_the_true_one)
{
    RNG random(2);
    for (int trial = 0; trial < 100; trial++)
    {
        const RelativePose truth = randomPose(random, 3);
        RelativePose poses[4];
        posesOf(essentialOf(truth) * random.uniform(-5., 5.), poses);
        double nearest = 9;
        for (const RelativePose& pose : poses)
            nearest = std::min(nearest, cv::norm(pose.R - truth.R) + cv::norm(pose.t - truth.t));
        EXPECT_LT(nearest, 1e-7);
    }
}

TEST(RelativePose, derivatives_are_those_of_finite_differences)
{
    RNG random(3);
    const RelativePose truth = randomPose(random, .3);
    const Views views(random, truth, 60, 10, .3);
    const Matx33d other(700, 0, 300, 0, 650, 200, 0, 0, 1);
    const EpipolarProblem problem(views.points1, views.points2, CAMERA, other);
    expectDerivatives(problem, truth, 40, 1e-4);
}

TEST(RelativePose, is_found_among_wrong_matches)
{
    RNG random(4);
    for (int wrong : {0, 60, 130})
        for (int trial = 0; trial < 10; trial++)
        {
            const RelativePose truth = randomPose(random, trial % 2 ? .3 : .02);
            const Views views(random, truth, 200, wrong, .2);
            Mat R, t, inliers;
            ASSERT_TRUE(
                    findRelativePose(views.points1, views.points2, Mat(CAMERA), Mat(CAMERA), R, t, inliers));
            EXPECT_EQ(CV_64F, R.type());
            EXPECT_EQ(Size(1, 3), t.size());
            EXPECT_NEAR(1, cv::norm(t), 1e-12);
            EXPECT_NEAR(0, cv::norm(Matx33d(R) * Matx33d(R).t() - Matx33d::eye()), 1e-12);
            EXPECT_LT(cv::norm(errorOf({R, Vec3d(t)}, truth)), .03) << wrong << ' ' << trial;
            ASSERT_EQ(Size(1, 200), inliers.size());
            EXPECT_GT(countNonZero(inliers.rowRange(wrong, 200)), .85 * (200 - wrong));
            EXPECT_LE(countNonZero(inliers.rowRange(0, wrong)), 10);
        }
}

/* Of independent errors the covariance foretells no less than they are, and not three times as much: it expects that matches
beside each other err together. */
TEST(RelativePose, covariance_foretells_the_errors)
{
    RNG random(5);
    const int trials = 200;
    int within = 0, far = 0;
    for (int trial = 0; trial < trials; trial++)
    {
        const RelativePose truth = randomPose(random, .2);
        const Views views(random, truth, 150, 20, .2);
        Mat R, t, covariance;
        ASSERT_TRUE(findRelativePose(
                views.points1, views.points2, Mat(CAMERA), Mat(CAMERA), R, t, noArray(), 0, covariance));
        ASSERT_EQ(Size(5, 5), covariance.size());
        const Mat error(errorOf({R, Vec3d(t)}, truth));
        const double distance = Mat(error.t() * covariance.inv() * error).at<double>(0);
        within += distance < 4.351 / 9;  // the median of chi-squared with five degrees of freedom
        far += distance > 15.09;         // 1 %
    }
    EXPECT_LT(within, .45 * trials);
    EXPECT_LE(far, .02 * trials);
}

// Few matches tell their own noise badly: five numbers are fitted to them, and a narrow scale is right of many poses.
TEST(RelativePose, covariance_foretells_the_errors_of_few_matches)
{
    const double median = 4.351, most = 11.07,
                 nearlyAll = 15.09;  // of chi-squared with five degrees of freedom
    for (int count : {10, 15, 25})
        for (double noise : {.1, .3, 1.})
        {
            RNG random(40);
            const int trials = 100;
            int found = 0, inside[3] = {};
            for (int trial = 0; trial < trials; trial++)
            {
                const RelativePose truth = randomPose(random, .2);
                const Views views(random, truth, count, 0, noise);
                RelativePose pose;
                Mat covariance;
                if (!findRelativePose(views.points1, views.points2, CAMERA, CAMERA, pose.R, pose.t, noArray(),
                            0, covariance))
                    continue;
                found++;
                const Vec<double, 5> error = errorOf(pose, truth);
                const double squared = error.dot(Matx<double, 5, 5>(covariance).inv() * error);
                inside[0] += squared < median;
                inside[1] += squared < most;
                inside[2] += squared < nearlyAll;
            }
            EXPECT_GE(found, count == 10 ? .5 * trials : .95 * trials) << count << ' ' << noise;
            EXPECT_GE(inside[0], .5 * found) << count << ' ' << noise;
            EXPECT_GE(inside[1], (noise < 1 ? .87 : count == 10 ? .7 : .82) * found) << count << ' ' << noise;
            EXPECT_GE(inside[2], (noise < 1            ? .92
                                         : count == 10 ? .76
                                                       : .87) *
                                         found)
                    << count << ' ' << noise;
        }
}

//! The same error in all matches of a part of the image, as a shadow makes it.
TEST(RelativePose, covariance_knows_of_errors_that_neighbours_share)
{
    RNG random(8);
    const int trials = 100;
    int within[2] = {0, 0};
    for (int trial = 0; trial < trials; trial++)
    {
        const RelativePose truth = randomPose(random, .2);
        Views views(random, truth, 200, 20, .1);
        Vec2d shifts[12];
        for (Vec2d& shift : shifts)
            random.fill(shift, RNG::NORMAL, 0, .2);
        for (int i = 0; i < views.points1.rows; i++)
        {
            const Vec2d at = views.points1.at<Vec2d>(i);
            const int part = std::clamp(int(at[0] / 160), 0, 3) + 4 * std::clamp(int(at[1] / 160), 0, 2);
            views.points2.at<Vec2d>(i) += shifts[part];
        }
        Mat R, t, covariance;
        ASSERT_TRUE(findRelativePose(
                views.points1, views.points2, Mat(CAMERA), Mat(CAMERA), R, t, noArray(), 0, covariance));
        const Mat error(errorOf({R, Vec3d(t)}, truth));
        const double distance = Mat(error.t() * covariance.inv() * error).at<double>(0);
        within[0] += distance < 4.351;
        within[1] += distance < 11.07;
    }
    EXPECT_GT(within[0], .4 * trials);
    EXPECT_GT(within[1], .8 * trials);
}

// A baseline of a thousandth of the depth, as tenths of a pixel tell it and pixels do not.
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
                Vec3d X = random.uniform(4., 12.) *
                          (CAMERA.inv() * Vec3d(random.uniform(0., 640.), random.uniform(0., 480.), 1));
                if (kind == 2)
                {
                    const double u = random.uniform(-1., 1.);
                    X = Vec3d(2 * u, .5 + .7 * u, 7 + 2 * u);
                }
                const double baselines[] = {1e-6, 1e-3, 1, 0};
                const Vec3d a = CAMERA * X, b = CAMERA * (truth.R * X + baselines[kind] * truth.t);
                for (int c = 0; c < 2; c++)
                {
                    const double noise = kind == 3 ? 0 : .2;
                    first.at<double>(i, c) = a[c] / a[2] + random.gaussian(noise);
                    second.at<double>(i, c) = kind == 3 && i < 60 ? random.uniform(0., 480.)
                                                                  : b[c] / b[2] + random.gaussian(noise);
                }
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

//! What became of poses of a plane, or of points about it.
struct OfPlane
{
    int right = 0, wrong = 0, untold = 0, refused = 0;  //!< untold: outside of a covariance

    //! @param relief by which part of their distance points are before or behind the plane
    OfPlane(int trials, int count, double relief)
    {
        for (int trial = 0; trial < trials; trial++)
        {
            RNG random(100 + trial);
            const RelativePose truth = randomPose(random, .1);
            Mat first(count, 2, CV_64F), second(count, 2, CV_64F), covariance;
            for (int i = 0; i < count; i++)
            {
                const Vec3d ray = CAMERA.inv() * Vec3d(random.uniform(0., 640.), random.uniform(0., 480.), 1);
                const double aside = relief > 0 ? random.uniform(-relief, relief) : 0;
                const Vec3d X = ray * (8 * (1 + aside) / (1 + .2 * ray[0] + .1 * ray[1])), a = CAMERA * X,
                            b = CAMERA * (truth.R * X + truth.t);
                for (int c = 0; c < 2; c++)
                {
                    first.at<double>(i, c) = a[c] / a[2] + random.gaussian(.2);
                    second.at<double>(i, c) = b[c] / b[2] + random.gaussian(.2);
                }
            }
            RelativePose pose;
            String reason;
            if (!findRelativePose(
                        first, second, CAMERA, CAMERA, pose.R, pose.t, noArray(), 0, covariance, &reason))
            {
                refused++;
                EXPECT_NE(reason.find("plane"), String::npos) << reason;
                continue;
            }
            const Vec<double, 5> error = errorOf(pose, truth);
            (cv::norm(error) < .1 ? right : wrong)++;
            untold += error.dot(Matx<double, 5, 5>(covariance).inv() * error) > 45;
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
        EXPECT_EQ(0, poses.untold) << count;
    }
    const OfPlane few(30, 30, 0);
    EXPECT_GE(few.right, 12);
    EXPECT_LE(few.wrong, 2);
    EXPECT_EQ(0, few.untold);
}

TEST(RelativePose, of_points_about_a_plane_is_found)
{
    for (int count : {30, 200})
    {
        const OfPlane poses(20, count, .05);
        EXPECT_EQ(20, poses.right) << count;
    }
}

// Five errors are small since five numbers were fitted to them.
TEST(RelativePose, a_scale_settles_by_what_no_number_was_fitted_to)
{
    std::vector<double> squared(12, .01);
    double scale = 0;
    EXPECT_TRUE(settles(squared, 1, 5, scale));
    EXPECT_NEAR(1.4826 * .1 * std::sqrt(12. / 7), scale, 1e-9);
    std::fill(squared.begin(), squared.begin() + 4, 4.);
    EXPECT_FALSE(settles(squared, 1, 5, scale));
    EXPECT_FALSE(settles(std::vector<double>(5, .01), 1, 5, scale));
}

TEST(RelativePose, the_residuals_tell_a_scale_of_any_size)
{
    RNG random(20);
    for (double noise : {1., 3., 5.})
    {
        int inside50 = 0, inside95 = 0;
        const int trials = 20;
        for (int trial = 0; trial < trials; trial++)
        {
            const RelativePose truth = randomPose(random, .2);
            const Views views(random, truth, 200, 0, noise);
            RelativePose pose;
            Mat covariance;
            ASSERT_TRUE(findRelativePose(views.points1, views.points2, Mat(CAMERA), Mat(CAMERA), pose.R,
                    pose.t, noArray(), 0, covariance));
            const Vec<double, 5> error = errorOf(pose, truth);
            const double chi2 = error.dot(Matx<double, 5, 5>(covariance).inv() * error);
            inside50 += chi2 < 4.35;
            inside95 += chi2 < 11.07;
        }
        EXPECT_GE(inside50, .4 * trials) << noise;
        EXPECT_GE(inside95, .85 * trials) << noise;
    }
}

// Which a scale that is too narrow by far would cut the errors off at.
TEST(RelativePose, covariance_is_that_of_the_residuals_whatever_scale_is_given)
{
    RNG random(22);
    for (double noise : {.25, 2., 4.})
    {
        int found = 0, inside50 = 0, inside95 = 0;
        const int trials = 30;
        for (int trial = 0; trial < trials; trial++)
        {
            const RelativePose truth = randomPose(random, .2);
            const Views views(random, truth, 150, 0, noise);
            RelativePose pose;
            Mat covariance;
            if (!findRelativePose(views.points1, views.points2, CAMERA, CAMERA, pose.R, pose.t, noArray(),
                        .25, covariance))
                continue;
            found++;
            const Vec<double, 5> error = errorOf(pose, truth);
            const double squared = error.dot(Matx<double, 5, 5>(covariance).inv() * error);
            inside50 += squared < 4.351;
            inside95 += squared < 11.07;
        }
        EXPECT_GE(found, .9 * trials) << noise;
        EXPECT_GE(inside50, .6 * found) << noise;
        EXPECT_GE(inside95, .9 * found) << noise;
    }
}

TEST(RelativePose, covariances_have_an_inverse)
{
    RNG random(21);
    int found = 0;
    for (int trial = 0; trial < 10; trial++)
    {
        const RelativePose truth = randomPose(random, .1);
        Mat points[2] = {Mat(200, 2, CV_64F), Mat(200, 2, CV_64F)};
        for (int i = 0; i < 200; i++)
        {
            const double u = random.uniform(-1., 1.);
            const Vec3d X(u * 2, .5 + u * .7, 7 + 2 * u);  // on a line, which tells no rotation about it
            const Vec3d seen[] = {CAMERA * X, CAMERA * (truth.R * X + truth.t)};
            for (int k = 0; k < 2; k++)
                for (int c = 0; c < 2; c++)
                    points[k].at<double>(i, c) = seen[k][c] / seen[k][2] + random.gaussian(.2);
        }
        Mat R, t, covariance, values;
        if (!findRelativePose(points[0], points[1], Mat(CAMERA), Mat(CAMERA), R, t, noArray(), 0, covariance))
            continue;
        found++;
        eigen(covariance, values);
        EXPECT_GT(values.at<double>(4), 0);
        EXPECT_GT(values.at<double>(0), 1) << "a rotation that nothing tells";
    }
    EXPECT_GE(found, 1);
}

TEST(RelativePose, is_the_same_again_in_both_depths_and_layouts)
{
    RNG random(6);
    const Views views(random, randomPose(random, .2), 100, 30, .2);
    Mat first, second, R[2], t[2];
    views.points1.convertTo(first, CV_32F);
    views.points2.convertTo(second, CV_32F);
    std::vector<Point2d> pairs1, pairs2;
    for (int i = 0; i < first.rows; i++)
    {
        pairs1.push_back(first.at<Point2f>(i));
        pairs2.push_back(second.at<Point2f>(i));
    }
    ASSERT_TRUE(findRelativePose(first, second, Mat(CAMERA), Mat(CAMERA), R[0], t[0]));
    ASSERT_TRUE(findRelativePose(pairs1, pairs2, CAMERA, Matx33f(CAMERA), R[1], t[1]));
    EXPECT_EQ(0, cvtest::norm(R[0], R[1], NORM_INF));
    EXPECT_EQ(0, cvtest::norm(t[0], t[1], NORM_INF));
}

//! Ten thousand matches of which two agree with whatever is proposed.
struct HopelessProblem
{
    double mostScale() const { return 1; }
    typedef double Model;
    typedef Vec<double, 1> Step;

    mutable int trials = 0;

    int size() const { return 10000; }
    int sampleSize() const { return 5; }
    int parameters() const { return 1; }
    void propose(const std::vector<int>&, std::vector<double>& models) const
    {
        trials++;
        models = {0};
    }
    double loss(double, double, double) const { return size() - 2; }
    void squaredErrors(double, std::vector<double>& errors) const
    {
        errors.assign(size(), 1e6);
        errors[0] = errors[1] = 0;
    }
    std::vector<double> alternatives(double) const { return {}; }
    std::vector<double> rivals(double, double) const { return {}; }
    bool areApart(double, double) const { return false; }
    void linearize(double, double, std::vector<Row<Step>>& rows) const { rows.clear(); }
    double moved(double model, const Step&) const { return model; }
};

// Of so few right matches no sample of five can be expected: 1 - share^5 is 1 in double precision.
TEST(RelativePose, hopeless_matches_are_tried_as_often_as_any)
{
    const HopelessProblem problem;
    robustFit(problem, 1);
    EXPECT_EQ(10000, problem.trials);
}

TEST(RelativePose, one_match_far_away_changes_little)
{
    RNG random(12);
    const RelativePose truth = randomPose(random, .1);
    Views views(random, truth, 300, 20, .2);
    Mat R, t, covariance, withFar;
    ASSERT_TRUE(
            findRelativePose(views.points1, views.points2, CAMERA, CAMERA, R, t, noArray(), 0, covariance));
    views.points1.at<Vec2d>(0) = views.points2.at<Vec2d>(0) = Vec2d(5e4, -2e4);
    ASSERT_TRUE(findRelativePose(views.points1, views.points2, CAMERA, CAMERA, R, t, noArray(), 0, withFar));
    EXPECT_LT(cv::norm(errorOf({R, Vec3d(t)}, truth)), .03);
    EXPECT_NEAR(1, std::sqrt(cv::trace(withFar)[0] / cv::trace(covariance)[0]), .5);
    for (double scale : {1e-200, 1e-3})  // as .1
    {
        ASSERT_TRUE(findRelativePose(
                views.points1, views.points2, CAMERA, CAMERA, R, t, noArray(), scale, covariance));
        EXPECT_LT(std::sqrt(cv::trace(covariance)[0]), .2);
    }
}

TEST(RelativePose, takes_columns_of_a_matrix_and_gives_fixed_sizes)
{
    RNG random(10);
    const Views views(random, randomPose(random, .2), 100, 30, .2);
    Mat both, R, t;
    hconcat(views.points1, views.points2, both);
    ASSERT_TRUE(findRelativePose(views.points1, views.points2, CAMERA, CAMERA, R, t));
    Matx33d fixedR;
    Vec3d fixedT;
    Matx<double, 5, 5> covariance;
    ASSERT_TRUE(findRelativePose(both.colRange(0, 2), both.colRange(2, 4), CAMERA, CAMERA, fixedR, fixedT,
            noArray(), 0, covariance));
    EXPECT_EQ(0, cvtest::norm(R, Mat(fixedR), NORM_INF));
    EXPECT_EQ(0, cvtest::norm(t, Mat(fixedT), NORM_INF));
    ASSERT_FALSE(findRelativePose(both(Rect(0, 0, 2, 4)), both(Rect(2, 0, 2, 4)), CAMERA, CAMERA, fixedR,
            fixedT, noArray(), 0, covariance));
    EXPECT_TRUE(std::isnan(fixedR(0, 0)) && std::isnan(fixedT[2]) && std::isnan(covariance(4, 4)));
}

TEST(RelativePose, too_few_matches_are_no_pose)
{
    RNG random(7);
    const Views views(random, randomPose(random, .2), 4, 0, 0);
    Mat R = Mat::eye(3, 3, CV_64F), t(3, 1, CV_64F), inliers, covariance = R;
    EXPECT_FALSE(findRelativePose(
            views.points1, views.points2, Mat(CAMERA), Mat(CAMERA), R, t, inliers, .25, covariance));
    EXPECT_TRUE(R.empty() && t.empty() && covariance.empty());
    EXPECT_EQ(0, countNonZero(inliers));
    EXPECT_EQ(4, inliers.rows);
    EXPECT_FALSE(findRelativePose(Mat(), std::vector<Point2f>(), Mat(CAMERA), Mat(CAMERA), R, t, inliers));
    EXPECT_TRUE(inliers.empty());
}

TEST(RelativePose, degenerate_matches_end_without_nonsense)
{
    const Mat one(50, 2, CV_32F, Scalar(100));
    Mat line(50, 2, CV_32F), R, t, covariance;
    for (int i = 0; i < 50; i++)
        line.at<Point2f>(i) = Point2f(10.f * i, 5.f * i);
    String reason;
    EXPECT_FALSE(findRelativePose(
            one, one, Mat(CAMERA), Mat(CAMERA), R, t, noArray(), .25, covariance, &reason));  // one place
    EXPECT_FALSE(reason.empty());
    // A camera that did not move, and points on a line: nothing tells a rotation about it, nor t.
    if (findRelativePose(line, line, Mat(CAMERA), Mat(CAMERA), R, t, noArray(), .25, covariance, &reason))
    {
        Mat values;
        ASSERT_TRUE(checkRange(R) && checkRange(t) && checkRange(covariance));
        eigen(covariance, values);
        EXPECT_GT(values.at<double>(1), 1);
    }
    else
        EXPECT_FALSE(reason.empty());
}

TEST(RelativePose, mistakes_are_told)
{
    const Mat points(10, 2, CV_32F, Scalar(1)), camera(CAMERA);
    Mat R, t, broken = points.clone(), skewed = camera.clone(), flat = camera.clone();
    broken.at<float>(3, 1) = std::numeric_limits<float>::quiet_NaN();
    skewed.at<double>(0, 1) = 1;
    flat.at<double>(1, 1) = 0;
    EXPECT_THROW(findRelativePose(points, points.rowRange(1, 10), camera, camera, R, t), cv::Exception);
    EXPECT_THROW(findRelativePose(Mat(10, 3, CV_32F), points, camera, camera, R, t), cv::Exception);
    EXPECT_THROW(findRelativePose(Mat(10, 2, CV_32S), points, camera, camera, R, t), cv::Exception);
    EXPECT_THROW(findRelativePose(points, broken, camera, camera, R, t), cv::Exception);
    EXPECT_THROW(findRelativePose(points, Mat(10, 2, CV_64F, Scalar(DBL_MAX)), camera, camera, R, t),
            cv::Exception);
    EXPECT_THROW(findRelativePose(points, points, skewed, camera, R, t), cv::Exception);
    EXPECT_THROW(findRelativePose(points, points, camera, flat, R, t), cv::Exception);
    EXPECT_THROW(findRelativePose(points, points, camera, Mat(), R, t), cv::Exception);
    EXPECT_THROW(findRelativePose(points, points, Mat(3, 3, CV_32S), camera, R, t), cv::Exception);
    for (double scale :
            {-1., std::numeric_limits<double>::infinity(), std::numeric_limits<double>::quiet_NaN()})
        EXPECT_THROW(findRelativePose(points, points, camera, camera, R, t, noArray(), scale), cv::Exception);
}

}  // namespace
}  // namespace opencv_test
