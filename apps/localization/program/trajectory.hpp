// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "opencv2/core/affine.hpp"
#include "opencv2/iib/localization.hpp"

namespace iib_localization {

//! A line of TUM's format, `name tx ty tz qx qy qz qw`: the camera's centre and the quaternion from it to the world.
std::string trajectoryLine(const std::string& name, const cv::Affine3d& cameraFromWorld);

//! `tx,ty,tz,qx,qy,qz,qw`. @throws cv::Exception (StsBadArg) for anything else.
cv::Affine3d parsePose(const std::string& text);

//! The time a name stands for: seconds, or nanoseconds (15 digits or more before the point).
std::optional<int64_t> nanoseconds(const std::string& name);

//! Reads EuRoC's imu.csv; times must rise.
std::vector<cv::iib::ImuReading> readImu(const std::string& path);

}  // namespace iib_localization
