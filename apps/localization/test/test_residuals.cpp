// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

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

}  // namespace
