// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "map.hpp"

namespace cv::iib {

/** What a pose in a map has of the map's own error, which its matches do not tell: the poses and the calibration of the map's
images are never exact. Some of these images are located by the points that the others place without them; how far they come to lie
from where the map has them, squared, is the error of any image that is located so (leave-one-out). Few of them leave directions in
which none strayed, so one more is among them, of their mean length and in all directions.
@return covariance of a camera's centre, in units of the distance to what it sees, and of a turn, both in the camera's axes; zeros
where no image tells, since points are seen by two images at most. */
Matx66d mapError(const Map& map);

//! The same in the world's axes. @param depth distance to what the camera sees
Matx66d inWorld(const Matx66d& error, const Affine3d& cameraFromWorld, double depth);

}  // namespace cv::iib
