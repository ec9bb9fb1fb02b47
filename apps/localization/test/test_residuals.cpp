// SPDX-License-Identifier: Apache-2.0

#include <random>

#include <ceres/gradient_checker.h>

#include "../src/residuals.hpp"
#include "opencv2/ts/ts_gtest.h"

namespace {
using namespace iib_localization;

typedef std::vector<std::vector<double>> Blocks;

const Eigen::Quaterniond TURN = Eigen::Quaterniond(0.8, 0.1, -0.3, 0.2).normalized();

Blocks withPose(const Blocks& others)
{
    Blocks blocks = {{TURN.x(), TURN.y(), TURN.z(), TURN.w()}, {1, -2, 0.5}};
    blocks.insert(blocks.end(), others.begin(), others.end());
    return blocks;
}

/** Compares the Jacobians with numeric differences. The caller keeps the function.
@param quaternions which of the blocks are rotations. */
void checkJacobians(
        const ceres::CostFunction& function, const Blocks& blocks, const std::vector<size_t>& quaternions)
{
    const ceres::EigenQuaternionManifold quaternion;
    std::vector<const ceres::Manifold*> manifolds(blocks.size(), nullptr);
    for (size_t i : quaternions)
        manifolds[i] = &quaternion;
    std::vector<const double*> pointers;
    for (const std::vector<double>& b : blocks)
        pointers.push_back(b.data());
    const ceres::GradientChecker checker(&function, &manifolds, ceres::NumericDiffOptions());
    ceres::GradientChecker::ProbeResults results;
    EXPECT_TRUE(checker.Probe(pointers.data(), 1e-6, &results)) << results.error_log;
}

TEST(Residuals, reprojection)
{
    const Pinhole camera = {500, 510, 320, 240};
    const std::unique_ptr<ceres::CostFunction> function(ReprojectionError::create(camera, {100, 200}));
    const Pose pose = {TURN, {1, -2, 0.5}};
    const Eigen::Vector3d point = pose.toWorld({0.5, -0.7, 3});
    const Blocks blocks = withPose({{point.x(), point.y(), point.z()}});
    checkJacobians(*function, blocks, {0});
    const double* pointers[] = {blocks[0].data(), blocks[1].data(), blocks[2].data()};
    double residual[2];
    ASSERT_TRUE(function->Evaluate(pointers, residual, nullptr));
    EXPECT_NEAR(500 * 0.5 / 3 + 320 - 100, residual[0], 1e-9);
    EXPECT_NEAR(510 * -0.7 / 3 + 240 - 200, residual[1], 1e-9);
    const Eigen::Vector3d behind = pose.toWorld({0, 0, -1});
    pointers[2] = behind.data();
    EXPECT_FALSE(function->Evaluate(pointers, residual, nullptr));
}

TEST(Residuals, focal_length)
{
    const Pinhole camera = {500, 510, 320, 240};
    const std::unique_ptr<ceres::CostFunction> function(FocalError::create(camera, {100, 200}));
    const Eigen::Vector3d point = Pose{TURN, {1, -2, 0.5}}.toWorld({0.5, -0.7, 3});
    const Blocks blocks = withPose({{point.x(), point.y(), point.z()}, {1.3}});
    checkJacobians(*function, blocks, {0});
    const double* pointers[] = {blocks[0].data(), blocks[1].data(), blocks[2].data(), blocks[3].data()};
    double residual[2];
    ASSERT_TRUE(function->Evaluate(pointers, residual, nullptr));
    EXPECT_NEAR(1.3 * 500 * 0.5 / 3 + 320 - 100, residual[0], 1e-9);
    EXPECT_NEAR(1.3 * 510 * -0.7 / 3 + 240 - 200, residual[1], 1e-9);
}

TEST(Residuals, line)
{
    const Pinhole camera = {500, 510, 320, 240};
    const Pose pose = {TURN, {1, -2, 0.5}};
    const LineObservation line = {
            pose.toWorld({0.5, -0.7, 3}), pose.toWorld({-0.2, 0.4, 2}), {{100, 200}, {130, 240}}};
    const std::unique_ptr<ceres::CostFunction> function(LineError::create(camera, line, 1.5));
    const Blocks blocks = withPose({});
    checkJacobians(*function, blocks, {0});
    const double* pointers[] = {blocks[0].data(), blocks[1].data()};
    double residual[2];
    ASSERT_TRUE(function->Evaluate(pointers, residual, nullptr));
    // along the segment (3, 4) / 5, so across it (-4, 3) / 5
    const double x[] = {500 * 0.5 / 3 + 320 - 100, 500 * -0.2 / 2 + 320 - 100};
    const double y[] = {510 * -0.7 / 3 + 240 - 200, 510 * 0.4 / 2 + 240 - 200};
    for (int i : {0, 1})
    {
        EXPECT_NEAR(1.5 * (-4 * x[i] + 3 * y[i]) / 5, residual[i], 1e-9);
        EXPECT_NEAR((-4 * x[i] + 3 * y[i]) / 5, line.segment.distance({x[i] + 100, y[i] + 200}), 1e-9);
    }
    LineObservation behind = line;
    behind.end = pose.toWorld({0, 0, -1});
    const std::unique_ptr<ceres::CostFunction> other(LineError::create(camera, behind, 1.5));
    EXPECT_FALSE(other->Evaluate(pointers, residual, nullptr));
}

TEST(Residuals, prior)
{
    const Pose pose = {TURN * Eigen::AngleAxisd(0.1, Eigen::Vector3d::UnitY()), {1.1, -2, 0.4}};
    const std::unique_ptr<ceres::CostFunction> function(PosePrior::create(pose, 0.02, 0.01));
    const Blocks blocks = withPose({});
    checkJacobians(*function, blocks, {0});
    const double* pointers[] = {blocks[0].data(), blocks[1].data()};
    Eigen::Matrix<double, 6, 1> residual;
    ASSERT_TRUE(function->Evaluate(pointers, residual.data(), nullptr));
    EXPECT_LT((residual.head<3>() - Eigen::Vector3d(-5, 0, 5)).norm(), 1e-9);
    EXPECT_NEAR(2 * std::sin(0.05) / 0.01, residual.tail<3>().norm(), 1e-9);
}

Preintegration someMotion(const ImuBias& bias)
{
    Preintegration p;
    p.bias = bias;
    for (int i = 0; i < 40; i++)
        p.add({0.3 + 0.01 * i, -0.2, 0.5}, {1, 9.5 - 0.1 * i, 0.3}, 0.01);
    return p;
}

TEST(Residuals, imu)
{
    const std::unique_ptr<ceres::CostFunction> function(
            ImuError::create(someMotion({{0.01, 0, 0}, {0, 0.1, 0}})));
    const Eigen::Quaterniond turn = TURN * Eigen::Quaterniond(0.9, 0.1, 0, 0.2).normalized();
    checkJacobians(*function,
            withPose({{1, 0.5, -0.2, 0.02, 0, 0.01, 0.1, 0, 0.2}, {turn.x(), turn.y(), turn.z(), turn.w()},
                    {1.5, -2, 0.6}, {1.1, 0.4, -0.3, 0.02, 0.01, 0.01, 0.1, 0.1, 0.2}, {0, 9.81, 0}}),
            {0, 3});
}

TEST(Residuals, state_prior)
{
    Matrix15 root = Matrix15::Random();
    const Pose pose = {TURN * Eigen::AngleAxisd(0.1, Eigen::Vector3d::UnitY()), {1.1, -2, 0.4}};
    const std::unique_ptr<ceres::CostFunction> function(StatePrior::create(
            pose, Eigen::Matrix<double, 9, 1>::Ones(), root * root.transpose() + Matrix15::Identity()));
    checkJacobians(*function, withPose({{1, 0.5, -0.2, 0.02, 0, 0.01, 0.1, 0, 0.2}}), {0});
}

// The derivatives by the bias against differences.
TEST(Preintegration, derivatives_by_the_bias)
{
    const double h = 1e-5;
    const Preintegration middle = someMotion({});
    for (int i = 0; i < 6; i++)
    {
        Preintegration ends[2];
        for (int side : {0, 1})
        {
            ImuBias bias;
            (i < 3 ? bias.rate[i] : bias.force[i - 3]) = side ? h : -h;
            ends[side] = someMotion(bias);
        }
        Eigen::Matrix<double, 9, 1> expected;
        expected << 2 * (ends[0].rotation.conjugate() * ends[1].rotation).vec(),
                ends[1].velocity - ends[0].velocity, ends[1].position - ends[0].position;
        EXPECT_LT((expected / (2 * h) - middle.byBias.col(i)).norm(), 1e-6) << i;
    }
}

// A thousand noisy copies of a motion scatter as the covariance says.
TEST(Preintegration, covariance_tells_the_noise)
{
    const double dt = 0.01, rateNoise = 2 * 1.7e-4 / std::sqrt(dt), forceNoise = 2 * 2.0e-3 / std::sqrt(dt);
    const Preintegration exact = someMotion({});
    std::mt19937 random(1);
    std::normal_distribution<double> normal;
    const auto noise = [&](double sigma) {
        const double x = normal(random), y = normal(random), z = normal(random);  // in this order
        return Eigen::Vector3d(sigma * x, sigma * y, sigma * z);
    };
    double sum = 0;
    const int trials = 1000;
    for (int t = 0; t < trials; t++)
    {
        Preintegration p;
        for (int i = 0; i < 40; i++)
        {
            const Eigen::Vector3d rate = Eigen::Vector3d(0.3 + 0.01 * i, -0.2, 0.5) + noise(rateNoise);
            const Eigen::Vector3d force = Eigen::Vector3d(1, 9.5 - 0.1 * i, 0.3) + noise(forceNoise);
            p.add(rate, force, dt);
        }
        Eigen::Matrix<double, 9, 1> error;
        error << 2 * (exact.rotation.conjugate() * p.rotation).vec(), p.velocity - exact.velocity,
                p.position - exact.position;
        sum += error.dot(exact.covariance.ldlt().solve(error));
    }
    EXPECT_NEAR(9, sum / trials, 0.6);  // the mean square in standard deviations; its own is 0.13
}

}  // namespace
