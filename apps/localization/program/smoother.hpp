// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "opencv2/core.hpp"
#include "opencv2/core/affine.hpp"

namespace iib_localization {

//! An inertial measurement, in the IMU's axes.
struct ImuReading
{
    int64_t nanoseconds;
    cv::Vec3d rate;   //!< rad/s
    cv::Vec3d force;  //!< m/s^2: acceleration without gravity's
};

//! What the smoother is told of an image.
struct VisualFrame
{
    int64_t nanoseconds;
    std::optional<cv::Affine3d> pose;  //!< world from camera; none if it told nothing
    cv::Matx66d covariance;            //!< as in Location
};

/** The poses (world from camera) of frames by the images' poses and an IMU's readings, in metres: a Kalman filter forwards and
the smoother of Rauch, Tung and Striebel backwards. Gravity's direction and the biases are found from the first poses.

Frames between get poses too, up to three seconds after the last image with one; before the first they have none. Without
readings between frames, or if the poses contradict gravity, the images' own poses stay.
@param frames in the order of their times. @param readings the same.
@param imuFromCamera where the camera is in the IMU's axes. */
std::vector<std::optional<cv::Affine3d>> smooth(const std::vector<VisualFrame>& frames,
        const std::vector<ImuReading>& readings, const cv::Affine3d& imuFromCamera);

}  // namespace iib_localization
