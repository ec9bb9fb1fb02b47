// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <ceres/ceres.h>

#include "imu.hpp"

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

//! The distances in pixels of a line's ends from the segment that it is seen as, times a weight. Of a pose.
struct LineError
{
    Pinhole camera;
    LineObservation line;
    double weight;

    template <typename T> bool operator()(const T* rotation, const T* position, T* residual) const
    {
        const Eigen::Vector2d along = line.segment.direction();
        const Eigen::Vector3d* const ends[] = {&line.begin, &line.end};
        for (int i = 0; i < 2; i++)
        {
            const Vector3<T> point = ends[i]->cast<T>();
            T offset[2];  // from the segment's beginning
            if (!ReprojectionError{camera, line.segment.begin}(rotation, position, point.data(), offset))
                return false;
            residual[i] = weight * (along.x() * offset[1] - along.y() * offset[0]);
        }
        return true;
    }

    static ceres::CostFunction* create(const Pinhole& camera, const LineObservation& line, double weight)
    {
        return new ceres::AutoDiffCostFunction<LineError, 2, 4, 3>(new LineError{camera, line, weight});
    }
};

//! ReprojectionError for a focal length that is `scale` times the camera's.
struct FocalError
{
    ReprojectionError given;

    template <typename T>
    bool operator()(const T* rotation, const T* position, const T* point, const T* scale, T* residual) const
    {
        if (!given(rotation, position, point, residual))
            return false;
        const Eigen::Vector2d offset(given.pixel.x() - given.camera.cx, given.pixel.y() - given.camera.cy);
        for (int i = 0; i < 2; i++)
            residual[i] = *scale * (residual[i] + T(offset[i])) - T(offset[i]);
        return true;
    }

    static ceres::CostFunction* create(const Pinhole& camera, const Eigen::Vector2d& pixel)
    {
        return new ceres::AutoDiffCostFunction<FocalError, 2, 4, 3, 3, 1>(
                new FocalError{ReprojectionError{camera, pixel}});
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

/** What an IMU measured between two states, less what the states say, in standard deviations. A state is a rotation, a
position, and its motion: velocity and the biases of rate and force. */
struct ImuError
{
    Preintegration measured;
    Eigen::Matrix<double, 9, 9> squareRootInformation;

    template <typename T>
    bool operator()(const T* rotation1, const T* position1, const T* motion1, const T* rotation2,
            const T* position2, const T* motion2, const T* gravity, T* residual) const
    {
        typedef Eigen::Map<const Vector3<T>> V;
        const Eigen::Map<const Eigen::Quaternion<T>> q1(rotation1), q2(rotation2);
        const V p1(position1), p2(position2), v1(motion1), v2(motion2), g(gravity);
        const T dt(measured.seconds);
        Eigen::Matrix<T, 6, 1> bias;
        bias << V(motion1 + 3) - measured.bias.rate, V(motion1 + 6) - measured.bias.force;
        const Eigen::Matrix<T, 9, 1> change = measured.byBias.cast<T>() * bias;

        Eigen::Quaternion<T> correction;  // of a small angle
        correction.vec() = change.template head<3>() / T(2);
        correction.w() = T(1);
        const Eigen::Quaternion<T> expected = measured.rotation.cast<T>() * correction.normalized();
        const Eigen::Quaternion<T> turn = expected.conjugate() * (q1.conjugate() * q2);
        Eigen::Map<Eigen::Matrix<T, 15, 1>> r(residual);
        Eigen::Matrix<T, 9, 1> error;
        error << turn.vec() * (turn.w() < T(0) ? T(-2) : T(2)),
                q1.conjugate() * Vector3<T>(v2 - v1 - g * dt) - measured.velocity -
                        change.template segment<3>(3),
                q1.conjugate() * Vector3<T>(p2 - p1 - v1 * dt - g * (dt * dt / T(2))) - measured.position -
                        change.template tail<3>();
        r.template head<9>() = squareRootInformation.cast<T>() * error;
        // biases change slowly; 1e-4 rad/s and 2e-3 m/s^2 in a second
        const double walk = std::sqrt(measured.seconds);
        r.template segment<3>(9) = (V(motion2 + 3) - V(motion1 + 3)) / T(1e-4 * walk);
        r.template segment<3>(12) = (V(motion2 + 6) - V(motion1 + 6)) / T(2e-3 * walk);
        return true;
    }

    static ceres::CostFunction* create(const Preintegration& measured)
    {
        const Eigen::Matrix<double, 9, 9> information = measured.covariance.inverse();
        return new ceres::AutoDiffCostFunction<ImuError, 15, 4, 3, 9, 4, 3, 9, 3>(
                new ImuError{measured, information.llt().matrixU()});
    }
};

typedef Eigen::Matrix<double, 15, 15> Matrix15;

//! How far a state is from a given one, in standard deviations.
struct StatePrior
{
    Pose pose;
    Eigen::Matrix<double, 9, 1> motion;
    Matrix15 squareRootInformation;

    template <typename T>
    bool operator()(const T* rotation, const T* position, const T* moving, T* residual) const
    {
        Eigen::Matrix<T, 15, 1> error;
        PosePrior{pose, 1, 1}(rotation, position, error.data());
        error.template tail<9>() = Eigen::Map<const Eigen::Matrix<T, 9, 1>>(moving) - motion;
        Eigen::Map<Eigen::Matrix<T, 15, 1>> r(residual);
        r = squareRootInformation.cast<T>() * error;
        return true;
    }

    //! @param covariance of position, rotation and motion.
    static ceres::CostFunction* create(
            const Pose& pose, const Eigen::Matrix<double, 9, 1>& motion, const Matrix15& covariance)
    {
        const Matrix15 information = covariance.inverse();
        return new ceres::AutoDiffCostFunction<StatePrior, 15, 4, 3, 9>(
                new StatePrior{pose, motion, information.llt().matrixU()});
    }
};

}  // namespace iib_localization
