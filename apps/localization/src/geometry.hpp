// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Dense>

// What both OpenCV's and Ceres's side of the application know; no header of either.
namespace iib_localization {

//! Where a camera is and how it is turned: from its axes (x right, y down, z forward) to the world's.
struct Pose
{
    Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();
    Eigen::Vector3d position = Eigen::Vector3d::Zero();

    Eigen::Vector3d toCamera(const Eigen::Vector3d& world) const
    {
        return rotation.conjugate() * (world - position);
    }
    Eigen::Vector3d toWorld(const Eigen::Vector3d& camera) const { return rotation * camera + position; }
};

//! A camera without distortion, in pixels; whole coordinates lie at the centres of pixels, as in OpenCV.
struct Pinhole
{
    double fx = 0, fy = 0, cx = 0, cy = 0;

    Eigen::Vector2d project(const Eigen::Vector3d& p) const
    {
        return {fx * p.x() / p.z() + cx, fy * p.y() / p.z() + cy};
    }
    //! The point at depth 1.
    Eigen::Vector3d ray(const Eigen::Vector2d& p) const { return {(p.x() - cx) / fx, (p.y() - cy) / fy, 1}; }
};

//! A point of the map, and where it is seen, without distortion.
struct Observation
{
    Eigen::Vector3d point;
    Eigen::Vector2d pixel;
};

//! A line segment of an image.
struct Segment
{
    Eigen::Vector2d begin, end;

    double length() const { return (end - begin).norm(); }
    Eigen::Vector2d direction() const { return (end - begin).normalized(); }
    //! The distance of a point from the line through the segment, in pixels; positive on one side.
    double distance(const Eigen::Vector2d& p) const
    {
        const Eigen::Vector2d d = direction(), v = p - begin;
        return d.x() * v.y() - d.y() * v.x();
    }
};

//! A piece of a line of the map, and the segment that it is seen as, without distortion.
struct LineObservation
{
    Eigen::Vector3d begin, end;
    Segment segment;
};

}  // namespace iib_localization
