// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "map.hpp"

namespace cv::iib {

/** Estimates the map's own error by leave-one-out: its images' poses and calibration are never exact, and matches do
not show this. Some images are located by the points that the other images triangulate. Their mean squared deviation
from their poses in the map is the error. A few images do not span all directions, so an isotropic sample of their mean
size is added.
@return covariance of a camera's centre, in units of the scene's distance, and of a rotation, both in the camera's axes;
zeros if no point is seen by three images. */
Matx66d mapError(const Map& map);

//! The map error in the world's axes. @param depth distance to the scene
Matx66d inWorld(const Matx66d& error, const Affine3d& cameraFromWorld, double depth);

}  // namespace cv::iib
