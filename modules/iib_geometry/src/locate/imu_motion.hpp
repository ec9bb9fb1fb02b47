// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "opencv2/iib/localization.hpp"

namespace cv::iib {

//! The motion of an IMU, its biases and gravity.
struct ImuState
{
    //! Offsets of an error's parts: rotation about the world's axes (rad), position (m), velocity (m/s), biases of rate
    //! (rad/s) and force (m/s^2), gravity (m/s^2).
    enum Part
    {
        TURN = 0,
        POSITION = 3,
        VELOCITY = 6,
        RATE = 9,
        FORCE = 12,
        DOWN = 15,
        SIZE = 18
    };
    typedef Vec<double, SIZE> Errors;
    typedef Matx<double, SIZE, SIZE> Matrix;

    Matx33d rotation = Matx33d::eye();  //!< world from IMU
    Vec3d position, velocity;           //!< m, m/s
    Vec3d rate, force;                  //!< the IMU's biases: rad/s, m/s^2
    Vec3d gravity;                      //!< m/s^2
};

//! A state changed by an error, and the error that changes `b` to `a`.
ImuState plus(const ImuState& state, const ImuState::Errors& errors);
ImuState::Errors minus(const ImuState& a, const ImuState& b);

/** Integrates a constant reading over dt seconds (Forster et al., On-manifold preintegration, 2017, section V):
    R' = R Exp(w dt),   v' = v + (R f + g) dt,   p' = p + v dt + (R f + g) dt^2 / 2,
with rate w and force f less their biases, and R at the middle of the rotation.
@param change receives the derivatives of the new errors by the old ones, each block to the lowest order of dt. */
void advance(ImuState& state, const Vec3d& rate, const Vec3d& force, double dt, ImuState::Matrix& change);

/** Integrates readings, interpolated linearly, from one time to another; false if they do not span it or have a gap.
@param covariance of the state, or null; if not null, `change` receives the derivatives as in advance(). */
bool integrate(const std::vector<ImuReading>& readings, int64 from, int64 to, ImuState& state,
        ImuState::Matrix* covariance, ImuState::Matrix* change);

/** The covariance of another point of a rigid body, and of its rotation: dp' = dp - [offset]x dw.
@param offset of the point, along the world's axes. */
Matx66d covarianceAt(const Matx66d& covariance, const Vec3d& offset);

}  // namespace cv::iib
