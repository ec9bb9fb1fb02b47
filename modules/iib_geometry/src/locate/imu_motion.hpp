// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "opencv2/iib/localization.hpp"

namespace cv::iib {

//! How an IMU moves, and what it takes to read it.
struct ImuState
{
    //! Places of an error's parts: turn about the world's axes (rad), position (m), velocity (m/s), biases of rate (rad/s) and
    //! force (m/s^2), gravity (m/s^2).
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

//! A state moved by an error, and the error that moves `b` to `a`.
ImuState plus(const ImuState& state, const ImuState::Errors& errors);
ImuState::Errors minus(const ImuState& a, const ImuState& b);

/** Moves a state by a reading that holds for dt seconds (Forster et al., On-manifold preintegration, 2017, section V):
    R' = R Exp(w dt),   v' = v + (R f + g) dt,   p' = p + v dt + (R f + g) dt^2 / 2,
with rate w and force f less their biases, and R in the middle of the turn.
@param change gets the derivatives of the new errors by the old ones, in each block to the lowest order of dt. */
void move(ImuState& state, const Vec3d& rate, const Vec3d& force, double dt, ImuState::Matrix& change);

/** Moves a state from one time to another; readings are linear between their times. False if they do not reach that far or have a
gap. @param covariance of the state, if not null; then change gets how errors change on the way. */
bool follow(const std::vector<ImuReading>& readings, int64 from, int64 to, ImuState& state,
        ImuState::Matrix* covariance, ImuState::Matrix* change);

/** The covariance of a place and of a turn, that of another place of the same body: dp' = dp - [way]x dw.
@param way there, along the world's axes. */
Matx66d carried(const Matx66d& covariance, const Vec3d& way);

}  // namespace cv::iib
