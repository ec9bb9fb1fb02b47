// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>
#include <vector>

#include "opencv2/core.hpp"

#include "geometry.hpp"

namespace iib_localization {

//! A camera as COLMAP describes it: PINHOLE, SIMPLE_RADIAL or OPENCV.
struct Camera
{
    std::string model;
    cv::Size size;
    std::vector<double> parameters;  //!< COLMAP's: centres of pixels lie at halves

    Pinhole pinhole() const;
    //! Removes the distortion of pixels whose centres lie at whole coordinates, as everywhere but in `parameters`.
    std::vector<Eigen::Vector2d> undistorted(const std::vector<cv::Point2f>& pixels) const;
    //! Distorts one.
    Eigen::Vector2d distorted(const Eigen::Vector2d& pixel) const;

private:
    //! k1, k2, p1, p2 of OpenCV
    std::vector<double> distortion() const;
};

//! Cameras by their ids.
typedef std::map<int, Camera> Cameras;

//! Reads COLMAP's cameras.txt. @throws cv::Exception for another model, bad values or no camera.
Cameras readCameras(const std::string& path);
void writeCameras(const std::string& path, const Cameras& cameras);

}  // namespace iib_localization
