// SPDX-License-Identifier: Apache-2.0

#include "pnp.hpp"

#include "opencv2/calib3d.hpp"

namespace iib_localization {
namespace {

constexpr double RANSAC_ERROR = 4;  // pixels
constexpr double INLIER_ERROR = 3;  // pixels, of a refined pose

}  // namespace

std::vector<Observation> agreeing(
        const std::vector<Observation>& matches, const Pinhole& camera, const Pose& pose)
{
    std::vector<Observation> inliers;
    for (const Observation& o : matches)
    {
        const Eigen::Vector3d seen = pose.toCamera(o.point);
        if (seen.z() > 0.1 && (camera.project(seen) - o.pixel).norm() < INLIER_ERROR)
            inliers.push_back(o);
    }
    return inliers;
}

bool poseByRansac(const std::vector<Observation>& matches, const Pinhole& p, Pose& pose)
{
    std::vector<cv::Point3d> points;
    std::vector<cv::Point2d> pixels;
    for (const Observation& o : matches)
    {
        points.emplace_back(o.point.x(), o.point.y(), o.point.z());
        pixels.emplace_back(o.pixel.x(), o.pixel.y());
    }
    cv::UsacParams parameters;
    parameters.score = cv::SCORE_METHOD_MAGSAC;
    parameters.threshold = RANSAC_ERROR;
    parameters.confidence = 0.999;
    parameters.maxIterations = 10000;
    cv::Mat matrix = (cv::Mat_<double>(3, 3) << p.fx, 0, p.cx, 0, p.fy, p.cy, 0, 0, 1), rotation, translation,
            inliers;
    if (!cv::solvePnPRansac(
                points, pixels, matrix, cv::noArray(), rotation, translation, inliers, parameters))
        return false;
    cv::Matx33d r;
    cv::Rodrigues(rotation, r);
    Eigen::Matrix3d fromWorld;
    fromWorld << r(0, 0), r(0, 1), r(0, 2), r(1, 0), r(1, 1), r(1, 2), r(2, 0), r(2, 1), r(2, 2);
    pose.rotation = Eigen::Quaterniond(fromWorld).conjugate().normalized();
    pose.position = -(pose.rotation * Eigen::Vector3d(translation.at<double>(0), translation.at<double>(1),
                                              translation.at<double>(2)));
    return pose.position.allFinite();
}

}  // namespace iib_localization
