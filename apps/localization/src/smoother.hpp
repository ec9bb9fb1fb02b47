// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "imu.hpp"

namespace iib_localization {

//! What the smoother is told of an image.
struct VisualFrame
{
    int64_t nanoseconds;
    std::optional<Pose> pose;            //!< none if the image told nothing
    std::vector<Observation> inliers{};  //!< points of the map, in that case
};

/** Poses from images and IMU together: a fixed-lag smoother over the last ten frames, whose factors are the points of the
map and the IMU between frames; older frames are kept as a prior. The direction of gravity in the map, the velocities
and the biases are found from the first frames. A frame without a pose of its own gets one within three seconds of one that
has, and frames that the IMU's readings do not connect start anew.
@param frames in the order of their times. */
std::vector<std::optional<Pose>> smooth(const Pinhole& camera, const std::vector<VisualFrame>& frames,
        const std::vector<ImuReading>& readings);

}  // namespace iib_localization
