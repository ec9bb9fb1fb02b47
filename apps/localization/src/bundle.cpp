// SPDX-License-Identifier: Apache-2.0

#include "bundle.hpp"

#include "residuals.hpp"

namespace iib_localization {
namespace {

constexpr double LOSS_SCALE = 1;  // pixels

ceres::Solver::Options solverOptions(ceres::LinearSolverType type)
{
    ceres::Solver::Options options;
    options.linear_solver_type = type;
    options.max_num_iterations = 50;
    options.logging_type = ceres::SILENT;
    return options;
}

}  // namespace

bool refinePose(const Pinhole& camera, const std::vector<Observation>& observations, RefinedPose& refined,
        const std::vector<LineObservation>& lines, double lineWeight)
{
    if (observations.size() + lines.size() < 3)
        return false;  // Ceres would not notice: it takes unknowns without equations for known
    std::vector<Eigen::Vector3d> points;
    points.reserve(observations.size());  // blocks of parameters do not move
    double* rotation = refined.pose.rotation.coeffs().data();
    double* position = refined.pose.position.data();
    ceres::Problem problem;
    problem.AddParameterBlock(rotation, 4, new ceres::EigenQuaternionManifold);
    problem.AddParameterBlock(position, 3);
    for (const Observation& o : observations)
    {
        points.push_back(o.point);
        problem.AddResidualBlock(ReprojectionError::create(camera, o.pixel),
                new ceres::CauchyLoss(LOSS_SCALE), rotation, position, points.back().data());
        problem.SetParameterBlockConstant(points.back().data());
    }
    for (const LineObservation& line : lines)
        problem.AddResidualBlock(LineError::create(camera, line, lineWeight),
                new ceres::CauchyLoss(LOSS_SCALE), rotation, position);
    ceres::Solver::Summary summary;
    ceres::Solve(solverOptions(ceres::DENSE_QR), &problem, &summary);
    ceres::Covariance::Options options;
    options.algorithm_type = ceres::DENSE_SVD;
    ceres::Covariance covariance(options);
    const std::vector<const double*> blocks = {position, rotation};
    if (!summary.IsSolutionUsable() || !covariance.Compute(blocks, &problem))
        return false;
    Eigen::Matrix<double, 6, 6, Eigen::RowMajor> c;
    if (!covariance.GetCovarianceMatrixInTangentSpace(blocks, c.data()))
        return false;
    // Ceres' tangent of a quaternion is half the angle.
    c.bottomRows<3>() *= 2;
    c.rightCols<3>() *= 2;
    refined.covariance = c;
    return c.allFinite();
}

double refineFocal(const Pinhole& camera, std::vector<View>& views, double& scale)
{
    ceres::Problem problem;
    problem.AddParameterBlock(&scale, 1);
    problem.SetParameterLowerBound(&scale, 0, 0.1);
    for (View& view : views)
    {
        double* rotation = view.pose.rotation.coeffs().data();
        problem.AddParameterBlock(rotation, 4, new ceres::EigenQuaternionManifold);
        for (Observation& o : view.inliers)
        {
            problem.AddResidualBlock(FocalError::create(camera, o.pixel), new ceres::CauchyLoss(LOSS_SCALE),
                    rotation, view.pose.position.data(), o.point.data(), &scale);
            problem.SetParameterBlockConstant(o.point.data());
        }
    }
    ceres::Solver::Summary summary;
    ceres::Solve(solverOptions(ceres::SPARSE_SCHUR), &problem, &summary);
    ceres::Covariance covariance((ceres::Covariance::Options()));
    const std::vector<const double*> blocks = {&scale};
    double variance = 0;
    if (!summary.IsSolutionUsable() || !covariance.Compute(blocks, &problem) ||
            !covariance.GetCovarianceBlock(&scale, &scale, &variance))
        return std::numeric_limits<double>::infinity();
    return std::sqrt(variance);
}

void adjustBundle(const std::vector<Sight>& sights, std::vector<Pose>& poses,
        std::vector<Eigen::Vector3d>& points, bool refinePoses)
{
    ceres::Problem problem;
    for (Pose& pose : poses)
    {
        double* rotation = pose.rotation.coeffs().data();
        double* position = pose.position.data();
        problem.AddParameterBlock(rotation, 4, new ceres::EigenQuaternionManifold);
        problem.AddParameterBlock(position, 3);
        if (refinePoses)
        {
            problem.AddResidualBlock(
                    PosePrior::create(pose, 0.02, 0.2 * M_PI / 180), nullptr, rotation, position);
            continue;
        }
        problem.SetParameterBlockConstant(rotation);
        problem.SetParameterBlockConstant(position);
    }
    for (const Sight& s : sights)
        problem.AddResidualBlock(ReprojectionError::create(s.camera, s.pixel),
                new ceres::CauchyLoss(LOSS_SCALE), poses[s.pose].rotation.coeffs().data(),
                poses[s.pose].position.data(), points[s.point].data());
    ceres::Solver::Summary summary;
    ceres::Solve(solverOptions(ceres::SPARSE_SCHUR), &problem, &summary);
}

}  // namespace iib_localization
