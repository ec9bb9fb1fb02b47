// SPDX-License-Identifier: Apache-2.0

#include <random>

#include "../src/bundle.hpp"
#include "opencv2/ts.hpp"

namespace {
using namespace iib_localization;

const Pinhole CAMERA = {500, 510, 319.5, 239.5};

//! Points before a camera with a known pose, and where it sees them.
struct Scene
{
    std::mt19937 random;
    Pose truth;
    std::vector<Observation> observations;

    explicit Scene(unsigned seed, int points = 60) : random(seed)
    {
        truth.rotation = Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, -1).normalized());
        truth.position = {10, -3, 4};
        std::uniform_real_distribution<double> unit(0, 1);
        for (int i = 0; i < points; i++)
        {
            const Eigen::Vector2d pixel(640 * unit(random), 480 * unit(random));
            const double depth = 3 + 12 * unit(random);
            observations.push_back({truth.toWorld(CAMERA.ray(pixel) * depth), pixel});
        }
    }
    //! Lines of about a metre, seen as what the truth makes of them.
    std::vector<LineObservation> lines(int count)
    {
        std::uniform_real_distribution<double> unit(0, 1);
        std::vector<LineObservation> result;
        for (int i = 0; i < count; i++)
        {
            const Eigen::Vector2d pixel(640 * unit(random), 480 * unit(random));
            const Eigen::Vector3d begin = CAMERA.ray(pixel) * (3 + 12 * unit(random));
            const Eigen::Vector3d end =
                    begin + Eigen::Vector3d(unit(random) - 0.5, unit(random) - 0.5, unit(random) - 0.5);
            result.push_back(
                    {truth.toWorld(begin), truth.toWorld(end), {CAMERA.project(begin), CAMERA.project(end)}});
        }
        return result;
    }
    void addNoise(double sigma)
    {
        std::normal_distribution<double> noise(0, sigma);
        for (Observation& o : observations)
            o.pixel += Eigen::Vector2d(noise(random), noise(random));
    }
    Pose nearby() const
    {
        return {truth.rotation * Eigen::AngleAxisd(0.02, Eigen::Vector3d::UnitX()),
                truth.position + Eigen::Vector3d(0.1, -0.1, 0.05)};
    }
};

TEST(RefinePose, finds_the_pose_despite_wrong_matches)
{
    Scene scene(1);
    for (size_t i = 0; i < 10; i++)
        scene.observations[i].pixel += Eigen::Vector2d(40, -30);
    RefinedPose refined{scene.nearby(), {}};
    ASSERT_TRUE(refinePose(CAMERA, scene.observations, refined));
    // the loss grows with the logarithm, so that what is wrong still pulls a little
    EXPECT_LT((refined.pose.position - scene.truth.position).norm(), 2e-3);
    EXPECT_LT(refined.pose.rotation.angularDistance(scene.truth.rotation), 2e-4);
}

// Errors in units of the covariance: their mean square is the number of coordinates, six. With Cauchy loss of the scale of
// the noise, about a fifth of the weight is lost twice over, so a mean of up to eight is right.
TEST(RefinePose, covariance_tells_the_error)
{
    double sum = 0;
    const int trials = 200;
    for (int i = 0; i < trials; i++)
    {
        Scene scene(unsigned(i) + 10);
        scene.addNoise(0.3);
        RefinedPose refined{scene.nearby(), {}};
        ASSERT_TRUE(refinePose(CAMERA, scene.observations, refined));
        Eigen::Matrix<double, 6, 1> error;
        const Eigen::AngleAxisd turn(refined.pose.rotation * scene.truth.rotation.conjugate());
        error << refined.pose.position - scene.truth.position, turn.angle() * turn.axis();
        sum += error.dot((refined.covariance * 0.3 * 0.3).ldlt().solve(error));
    }
    EXPECT_GT(sum / trials, 4.5);
    EXPECT_LT(sum / trials, 8);
}

// Five points with an error of a pixel, and forty lines with one of 0.3 pixels, of which four are wrong.
TEST(RefinePose, lines_make_a_pose_of_few_points_better)
{
    double sums[2] = {0, 0};  // without and with lines
    for (unsigned seed = 0; seed < 20; seed++)
    {
        Scene scene(seed, 5);
        scene.addNoise(1);
        std::vector<LineObservation> lines = scene.lines(40);
        std::normal_distribution<double> noise(0, 0.3);
        for (size_t i = 0; i < lines.size(); i++)
        {
            const double wrong = i < 4 ? 5 : 0;
            for (Eigen::Vector2d* end : {&lines[i].segment.begin, &lines[i].segment.end})
                *end += Eigen::Vector2d(noise(scene.random) + wrong, noise(scene.random) - wrong);
        }
        for (bool withLines : {false, true})
        {
            RefinedPose refined{scene.nearby(), {}};
            ASSERT_TRUE(refinePose(CAMERA, scene.observations, refined,
                    withLines ? lines : std::vector<LineObservation>(), 1 / 0.3));
            sums[withLines] += (refined.pose.position - scene.truth.position).norm();
        }
    }
    EXPECT_LT(sums[1], 0.25 * sums[0]);
    EXPECT_LT(sums[1] / 20, 0.01);
}

// As of points: the mean square in units of the covariance is the number of coordinates.
TEST(RefinePose, covariance_tells_the_error_of_lines_too)
{
    double sum = 0;
    const int trials = 200;
    for (int i = 0; i < trials; i++)
    {
        Scene scene(unsigned(i) + 10, 10);
        scene.addNoise(0.3);
        std::vector<LineObservation> lines = scene.lines(30);
        std::normal_distribution<double> noise(0, 0.6);
        for (LineObservation& line : lines)
            for (Eigen::Vector2d* end : {&line.segment.begin, &line.segment.end})
                *end += Eigen::Vector2d(noise(scene.random), noise(scene.random));
        RefinedPose refined{scene.nearby(), {}};
        ASSERT_TRUE(refinePose(CAMERA, scene.observations, refined, lines, 0.5));
        Eigen::Matrix<double, 6, 1> error;
        const Eigen::AngleAxisd turn(refined.pose.rotation * scene.truth.rotation.conjugate());
        error << refined.pose.position - scene.truth.position, turn.angle() * turn.axis();
        sum += error.dot((refined.covariance * 0.3 * 0.3).ldlt().solve(error));
    }
    EXPECT_GT(sum / trials, 4.5);
    EXPECT_LT(sum / trials, 8);
}

TEST(RefinePose, says_when_points_do_not_determine_the_pose)
{
    Scene two(2, 2);
    RefinedPose refined{two.nearby(), {}};
    EXPECT_FALSE(refinePose(CAMERA, two.observations, refined));

    Scene line(2, 20);
    for (int i = 0; i < 20; i++)
    {
        const Eigen::Vector3d seen(0.1 * i - 1, 0.05 * i, 5 + 0.1 * i);
        line.observations[size_t(i)] = {line.truth.toWorld(seen), CAMERA.project(seen)};
    }
    refined.pose = line.truth;
    EXPECT_FALSE(refinePose(CAMERA, line.observations, refined)) << "the camera may turn about the line";
}

TEST(AdjustBundle, moves_points_and_only_if_asked_poses)
{
    Scene scene(3);
    std::vector<Pose> truth(3, scene.truth);
    truth[1].position += Eigen::Vector3d(0.8, 0, 0.1);
    truth[2].position += Eigen::Vector3d(-0.3, 0.9, 0);
    std::vector<Eigen::Vector3d> points;
    std::vector<Sight> sights;
    for (const Observation& o : scene.observations)
    {
        for (int p = 0; p < 3; p++)
            sights.push_back({p, int(points.size()), CAMERA, CAMERA.project(truth[p].toCamera(o.point))});
        points.push_back(o.point);
    }
    const std::vector<Eigen::Vector3d> right = points;
    for (size_t i = 0; i < points.size(); i++)
        points[i] += Eigen::Vector3d(0.1 * double(i % 3), -0.1, 0.05 * double(i % 5));

    std::vector<Pose> poses = truth;
    std::vector<Eigen::Vector3d> adjusted = points;
    adjustBundle(sights, poses, adjusted, false);
    for (size_t i = 0; i < points.size(); i++)
        EXPECT_LT((adjusted[i] - right[i]).norm(), 1e-4);

    poses[2].position += Eigen::Vector3d(0.02, 0, -0.02);
    std::vector<Pose> moved = poses;
    adjusted = points;
    adjustBundle(sights, moved, adjusted, false);
    EXPECT_EQ(poses[2].position, moved[2].position);
    adjusted = points;
    adjustBundle(sights, moved, adjusted, true);
    EXPECT_LT((moved[2].position - truth[2].position).norm(), 0.02);
}

}  // namespace
