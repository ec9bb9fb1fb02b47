// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "geometry.hpp"

namespace iib_localization {

//! An inertial measurement in the camera's axes.
struct ImuReading
{
    int64_t nanoseconds;
    Eigen::Vector3d rate;   //!< rad/s
    Eigen::Vector3d force;  //!< m/s^2: acceleration without gravity's
};

struct ImuBias
{
    Eigen::Vector3d rate = Eigen::Vector3d::Zero();
    Eigen::Vector3d force = Eigen::Vector3d::Zero();
};

/** The motion between two times as an IMU saw it, in the axes of the first time, with gravity and the first velocity
left out (Forster et al., On-Manifold Preintegration, 2017). */
struct Preintegration
{
    double seconds = 0;
    Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();
    Eigen::Vector3d velocity = Eigen::Vector3d::Zero();
    Eigen::Vector3d position = Eigen::Vector3d::Zero();
    ImuBias bias;  //!< that was taken off the readings
    //! Derivatives by the bias of rate (columns 0 to 2) and force (3 to 5) of rotation, velocity and position (rows).
    Eigen::Matrix<double, 9, 6> byBias = Eigen::Matrix<double, 9, 6>::Zero();
    //! Of rotation (vector in the axes of the second time), velocity and position.
    Eigen::Matrix<double, 9, 9> covariance = Eigen::Matrix<double, 9, 9>::Zero();

    //! Goes on by a reading that holds for some seconds.
    void add(const Eigen::Vector3d& rate, const Eigen::Vector3d& force, double dt);
};

/** Readings are linear between their times.
@return false if the readings do not reach from one time to the other, or have a gap of more than 0.1 s between. */
bool preintegrate(const std::vector<ImuReading>& readings, int64_t from, int64_t to, const ImuBias& bias,
        Preintegration& result);

}  // namespace iib_localization
