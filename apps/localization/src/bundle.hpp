// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "geometry.hpp"

// Least squares with Ceres, whose headers the OpenCV side of the application does not see.
namespace iib_localization {

//! Points of the map err together, so each counts as less than an independent pixel would.
constexpr double POINT_WEIGHT = 0.2;

struct RefinedPose
{
    Pose pose;
    //! Of the position in metres and of a small rotation of the world's axes in radians, for errors of one pixel.
    Eigen::Matrix<double, 6, 6> covariance;
};

/** Least reprojection error with Cauchy loss.
@param lines what is seen of lines, whose distances count `lineWeight` times as much as those of points.
@return false if points and lines do not determine the pose. */
bool refinePose(const Pinhole& camera, const std::vector<Observation>& observations, RefinedPose& refined,
        const std::vector<LineObservation>& lines = {}, double lineWeight = 1);

//! An image with its pose, and the points that agree with it.
struct View
{
    Pose pose;
    std::vector<Observation> inliers;
};

/** Moves the poses and one focal length to the least reprojection error.
@param scale of the camera's focal length: a first guess and the result.
@return the standard deviation of `scale` for errors of one pixel; infinite if the points do not determine it. */
double refineFocal(const Pinhole& camera, std::vector<View>& views, double& scale);

//! A sight of a point by a pose, both by index.
struct Sight
{
    int pose, point;
    Pinhole camera;
    Eigen::Vector2d pixel;
};

/** Bundle adjustment: moves the points, and with `refinePoses` the poses, which a prior holds near where they were
(2 cm, 0.2 degrees), since they are where the world's frame comes from. */
void adjustBundle(const std::vector<Sight>& sights, std::vector<Pose>& poses,
        std::vector<Eigen::Vector3d>& points, bool refinePoses);

}  // namespace iib_localization
