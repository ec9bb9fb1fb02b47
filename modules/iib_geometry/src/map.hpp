// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "opencv2/iib/localization.hpp"

namespace iib_localization {

//! An image of a map.
struct View
{
    cv::Range rows;               //!< of Map::codes and Map::sees; the strongest keypoints first
    cv::Vec3d centre, direction;  //!< of its camera, in the world
    double depth = 1;             //!< median distance to what it sees
};

//! A map as Python's opencv_iib.localization writes it; see doc/maps.md.
struct Map
{
    int keypoints = 2000;  //!< that are looked for in an image
    std::vector<cv::iib::Camera> cameras;
    std::vector<View> views;
    cv::Mat codes;   //!< N x bytes, CV_8U
    cv::Mat sees;    //!< N x 1, CV_32S: the row of `points` that each keypoint sees
    cv::Mat points;  //!< P x 3, CV_64F

    const cv::Point3d& point(int number) const { return *points.ptr<cv::Point3d>(number); }
};

//! @throws cv::Exception for what is no map, or a damaged one.
Map readMap(const std::string& folder);

}  // namespace iib_localization
