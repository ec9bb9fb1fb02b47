// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#ifndef IIB_LOCALIZATION_RESIDUALS_HPP
#define IIB_LOCALIZATION_RESIDUALS_HPP

#include <ceres/ceres.h>

#include "geometry.hpp"

namespace iib_localization {

template <typename T> using Vector3 = Eigen::Matrix<T, 3, 1>;

//! Where the point is seen, less where it should be, in pixels. Of a pose's rotation (x, y, z, w), position and a point.
struct ReprojectionError
{
    Pinhole camera;
    Eigen::Vector2d pixel;

    template <typename T>
    bool operator()(const T* rotation, const T* position, const T* point, T* residual) const
    {
        const Eigen::Map<const Eigen::Quaternion<T>> q(rotation);
        const Vector3<T> p = q.conjugate() *
                             (Eigen::Map<const Vector3<T>>(point) - Eigen::Map<const Vector3<T>>(position));
        if (p.z() < T(1e-3))
            return false;  // behind the camera: Ceres takes a shorter step
        residual[0] = camera.fx * p.x() / p.z() + camera.cx - pixel.x();
        residual[1] = camera.fy * p.y() / p.z() + camera.cy - pixel.y();
        return true;
    }

    static ceres::CostFunction* create(const Pinhole& camera, const Eigen::Vector2d& pixel)
    {
        return new ceres::AutoDiffCostFunction<ReprojectionError, 2, 4, 3, 3>(
                new ReprojectionError{camera, pixel});
    }
};

//! How far a pose is from a given one, in units of what is usual.
struct PosePrior
{
    Pose pose;
    double metres, radians;

    template <typename T> bool operator()(const T* rotation, const T* position, T* residual) const
    {
        const Eigen::Quaternion<T> turn =
                Eigen::Map<const Eigen::Quaternion<T>>(rotation) * pose.rotation.conjugate().cast<T>();
        Eigen::Map<Eigen::Matrix<T, 6, 1>> r(residual);
        r.template head<3>() = (Eigen::Map<const Vector3<T>>(position) - pose.position.cast<T>()) / T(metres);
        r.template tail<3>() = turn.vec() * (turn.w() < T(0) ? T(-2) : T(2)) / T(radians);
        return true;
    }

    static ceres::CostFunction* create(const Pose& pose, double metres, double radians)
    {
        return new ceres::AutoDiffCostFunction<PosePrior, 6, 4, 3>(new PosePrior{pose, metres, radians});
    }
};

}  // namespace iib_localization

#endif
