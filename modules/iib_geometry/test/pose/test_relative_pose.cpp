// SPDX-License-Identifier: Apache-2.0

#include <atomic>

#include "../derivatives.hpp"
#include "pose/epipolar_problem.hpp"
#include "pose/five_points.hpp"
#include "two_cameras.hpp"

namespace opencv_test { namespace {
using namespace cv::iib;

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
            first[i] = moved(CAMERA.inv(), views.points1[i]);
            second[i] = moved(CAMERA.inv(), views.points2[i]);
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
            const PoseResult found(Views(random, truth, 200, wrong, .2));
            ASSERT_TRUE(found.found) << found.reason;
            EXPECT_NEAR(1, cv::norm(found.pose.t), 1e-12);
            EXPECT_NEAR(0, cv::norm(found.pose.R * found.pose.R.t() - Matx33d::eye()), 1e-12);
            EXPECT_LT(cv::norm(found.error(truth)), .03) << wrong << ' ' << trial;
            ASSERT_EQ(Size(1, 200), found.inliers.size());
            EXPECT_GT(countNonZero(found.inliers.rowRange(wrong, 200)), .85 * (200 - wrong));
            EXPECT_LE(countNonZero(found.inliers.rowRange(0, wrong)), 10);
        }
}

// The exact half is fitted at its own narrow scale. At a scale that suits all matches, the median error is .011.
TEST(RelativePose, half_of_few_matches_being_inexact_changes_little)
{
    RNG random(79);
    std::vector<double> errors;
    for (int trial = 0; trial < 100; trial++)
    {
        const RelativePose truth = randomPose(random, .2);
        Views views(random, truth, 36, 0, .02);
        for (int i = 0; i < 18; i++)
            views.points2[i] += Point2d(random.gaussian(3), random.gaussian(3));
        const PoseResult result(views);
        ASSERT_TRUE(result.found) << result.reason;
        errors.push_back(cv::norm(result.error(truth)));
    }
    EXPECT_LT(median(errors), .0025);
}

//! A model is a random number seeded by its sample, so the result depends on every sample that was tried.
struct SenselessProblem
{
    typedef uint64 Model;
    typedef Vec<double, 1> Step;

    uint64 seed = 0;

    int size() const { return 40; }
    int sampleSize() const { return 3; }
    int parameters() const { return 1; }
    void propose(const std::vector<int>& sample, std::vector<Model>& models) const
    {
        models = {RNG(seed + (sample[0] * 40 + sample[1]) * 40 + sample[2]).next()};
    }
    double loss(Model model, const Loss&, double) const { return RNG(model).uniform(0., 1.); }
    void squaredErrors(Model model, std::vector<double>& errors) const
    {
        RNG random(model + 1);
        errors.resize(size());
        for (double& error : errors)
            error = random.uniform(0., 18.);
    }
    void linearize(Model, double, std::vector<Row<Step>>& rows) const { rows.clear(); }
    Model moved(Model model, const Step&) const { return model; }
};

//! Ten thousand matches; the same two agree with every proposed model.
struct HopelessProblem : SenselessProblem
{
    mutable std::atomic<int> trials{0};

    int size() const { return 10000; }
    int sampleSize() const { return 5; }
    void propose(const std::vector<int>&, std::vector<Model>& models) const
    {
        trials++;
        models = {0};
    }
    double loss(Model, const Loss&, double) const { return size() - 2; }
    void squaredErrors(Model, std::vector<double>& errors) const
    {
        errors.assign(size(), 1e6);
        errors[0] = errors[1] = 0;
    }
};

// A sample without wrong matches cannot be expected: 1 - share^5 is 1 in double precision.
TEST(RelativePose, hopeless_matches_get_the_most_samples)
{
    const HopelessProblem problem;
    EXPECT_EQ(10000, robustFit(problem).samples);
    EXPECT_EQ(10000, problem.trials);
}

TEST(RelativePose, does_not_depend_on_the_number_of_threads)
{
    const int before = getNumThreads();
    for (uint64 seed = 0; seed < 200; seed++)
    {
        setNumThreads(1);
        const Fit<SenselessProblem> expected = robustFit(SenselessProblem{seed << 32});
        for (int threads : {2, 3, 8})
        {
            setNumThreads(threads);
            const Fit<SenselessProblem> found = robustFit(SenselessProblem{seed << 32});
            EXPECT_EQ(expected.model, found.model) << seed << ", " << threads;
            EXPECT_EQ(expected.samples, found.samples) << seed << ", " << threads;
        }
    }
    setNumThreads(before);
}

TEST(RelativePose, one_match_far_away_changes_little)
{
    RNG random(12);
    const RelativePose truth = randomPose(random, .1);
    Views views(random, truth, 300, 20, .2);
    const PoseResult before(views);
    views.points1[0] = views.points2[0] = Point2d(5e4, -2e4);
    const PoseResult withFar(views);
    ASSERT_TRUE(before.found && withFar.found);
    EXPECT_LT(cv::norm(withFar.error(truth)), .03);
    EXPECT_NEAR(1, std::sqrt(cv::trace(withFar.covariance) / cv::trace(before.covariance)), .5);
    for (double scale : {1e-200, 1e-3})  // raised to .1
    {
        const PoseResult narrow(views, scale);
        ASSERT_TRUE(narrow.found);
        EXPECT_LT(std::sqrt(cv::trace(narrow.covariance)), .2);
    }
}

TEST(RelativePose, takes_both_depths_and_all_layouts_and_gives_fixed_sizes)
{
    RNG random(10);
    const Views views(random, randomPose(random, .2), 100, 30, .2);
    const std::vector<Point2f> first(views.points1.begin(), views.points1.end()),
            second(views.points2.begin(), views.points2.end());
    const Points one(first.begin(), first.end()), other(second.begin(), second.end());
    Mat both, R, t;
    const int count = (int)first.size();
    hconcat(Mat(first).reshape(1, count), Mat(second).reshape(1, count), both);
    ASSERT_TRUE(findRelativePose(first, second, Mat(CAMERA), Matx33f(CAMERA), R, t));
    EXPECT_EQ(CV_64F, R.type());
    EXPECT_EQ(Size(1, 3), t.size());
    Matx33d fixedR;
    Vec3d fixedT;
    Matx<double, 5, 5> covariance;
    ASSERT_TRUE(findRelativePose(both.colRange(0, 2), both.colRange(2, 4), CAMERA, CAMERA, fixedR, fixedT,
            noArray(), 0, covariance));
    const PoseResult again(one, other);
    const int sizes[] = {count, 1, 2};
    Matx33d deepR;
    Vec3d deepT;
    ASSERT_TRUE(findRelativePose(Mat(first).reshape(1, 3, sizes), second, CAMERA, CAMERA, deepR, deepT));
    for (const RelativePose& same : {again.pose, RelativePose{fixedR, fixedT}, RelativePose{deepR, deepT}})
    {
        EXPECT_EQ(Matx33d(R), same.R);
        EXPECT_EQ(Vec3d(t), same.t);
    }
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

TEST(RelativePose, degenerate_matches_give_a_reason_or_a_large_deviation)
{
    const Mat one(50, 2, CV_32F, Scalar(100));
    Mat line(50, 2, CV_32F);
    for (int i = 0; i < 50; i++)
        line.at<Point2f>(i) = Point2f(10.f * i, 5.f * i);
    const PoseResult same(one, one, .25), still(line, line, .25);
    EXPECT_FALSE(same.found || same.reason.empty()) << "all points are the same";
    EXPECT_EQ(still.found, still.reason.empty());
    // The camera did not move and the points are on a line: rotation about the line and t are undetermined.
    Vec<double, 5> values = Vec<double, 5>::all(2);
    if (still.found)
        eigen(still.covariance, values);
    EXPECT_GT(values[1], 1);
}

// Also for large rotations and large angles between directions.
TEST(RelativePose, steps_lead_to_other_poses)
{
    const RelativePose pose = {Matx33d::eye(), Vec3d(1, 0, 0)};
    const Vec3d turn(.5, -.8, 1.1);
    const RelativePose turned = moved(pose, Vec<double, 5>(turn[0], turn[1], turn[2], 0, 0)),
                       other = {Matx33d::eye(), Vec3d(std::cos(2.), std::sin(2.), 0)};
    EXPECT_LT(cv::norm(turned.R, Affine3d(turn).rotation()), 1e-12);
    EXPECT_LT(cv::norm(Vec3d(stepBetween(pose, turned).val), turn), 1e-12);
    EXPECT_NEAR(2, cv::norm(stepBetween(pose, other)), 1e-12);
    EXPECT_NEAR(CV_PI, cv::norm(stepBetween(pose, {pose.R, -pose.t})), 1e-12);
}

// For odd cameras, OpenCV's decomposition of a homography returns matrices that are no rotations.
TEST(RelativePose, poses_of_a_plane_have_rotations_for_any_camera)
{
    const Matx33d camera(.001, 0, 320, 0, 500, 240, 0, 0, 1);
    Points first, second;
    RNG random(3);
    for (int i = 0; i < 12; i++)  // on a line
    {
        first.emplace_back(100 + 35 * i, 277 + 6 * i);
        second.push_back(first.back() + Point2d(random.gaussian(.3), random.gaussian(.3)));
    }
    const EpipolarProblem problem(first, second, camera, camera);
    int count = 0;
    for (int trial = 0; trial < 200; trial++)
    {
        Vec<double, 5> step;
        for (int k = 0; k < 5; k++)
            step[k] = random.gaussian(trial < 100 ? 1 : 1e-5);
        const RelativePose pose = moved(RelativePose{Matx33d::eye(), Vec3d(1, 0, 0)}, step);
        for (const RelativePose& rival : problem.rivals(pose, 1))
        {
            EXPECT_LT(cv::norm(rival.R * rival.R.t(), Matx33d::eye()), 1e-9);
            count++;
        }
    }
    EXPECT_GT(count, 0);
}

TEST(RelativePose, invalid_arguments_are_refused)
{
    const Mat points(10, 2, CV_32F, Scalar(1)), camera(CAMERA);
    Mat R, t, broken = points.clone(), skewed = camera.clone(), flat = camera.clone();
    broken.at<float>(3, 1) = std::numeric_limits<float>::quiet_NaN();
    skewed.at<double>(0, 1) = 1;
    flat.at<double>(1, 1) = 0;
    for (const Mat& wrong : {Mat(points.rowRange(1, 10)), Mat(10, 3, CV_32F), Mat(10, 2, CV_32S), broken,
                 Mat(10, 2, CV_64F, Scalar(DBL_MAX)), Mat(10, 2, CV_64F, Scalar(1e10))})
    {
        EXPECT_THROW(findRelativePose(points, wrong, camera, camera, R, t), cv::Exception) << wrong;
        EXPECT_THROW(findRelativePose(wrong, points, camera, camera, R, t), cv::Exception) << wrong;
    }
    for (const Mat& wrong : {skewed, flat, Mat(), Mat(3, 3, CV_32S)})
    {
        EXPECT_THROW(findRelativePose(points, points, wrong, camera, R, t), cv::Exception) << wrong;
        EXPECT_THROW(findRelativePose(points, points, camera, wrong, R, t), cv::Exception) << wrong;
    }
    for (double scale :
            {-1., std::numeric_limits<double>::infinity(), std::numeric_limits<double>::quiet_NaN()})
        EXPECT_THROW(findRelativePose(points, points, camera, camera, R, t, noArray(), scale), cv::Exception);
}

}}  // namespace opencv_test
