// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "imu.hpp"

namespace iib_localization {

struct NamedPose
{
    std::string name;  //!< an image's without extension, or a time stamp
    Pose pose;
};

//! Reads TUM's format: `name tx ty tz qx qy qz qw`, camera to world.
std::vector<NamedPose> readTrajectory(const std::string& path);
void writeTrajectory(const std::string& path, const std::vector<NamedPose>& poses);

//! The time a name stands for: seconds, or nanoseconds (15 digits or more before the point).
std::optional<int64_t> nanoseconds(const std::string& name);

//! The pose of an image: that of the same name, else that of the same time to a microsecond; null if there is none.
const Pose* findPose(const std::vector<NamedPose>& poses, const std::string& name);

//! Reads EuRoC's imu.csv; times must rise.
std::vector<ImuReading> readImu(const std::string& path);

}  // namespace iib_localization
