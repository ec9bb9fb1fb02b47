// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "features.hpp"
#include "map.hpp"

namespace iib_localization {

struct MapSources
{
    std::string images;   //!< a folder
    std::string cameras;  //!< cameras.txt with one camera; not needed if `poses` is a model
    std::string poses;    //!< a trajectory, or the folder of a COLMAP model
    std::string
            depth;  //!< a folder with 16-bit images in millimetres, 0 unknown; empty: points are triangulated
    std::string features = "iib";
    bool refinePoses = false;  //!< of a triangulated map
};

/** Makes a map of those images that have a pose.
@throws cv::Exception for bad sources, or if fewer than one keyframe or ten points come out. */
Map buildMap(const MapSources& sources);

/** Depth at a pixel, in metres: interpolated between four pixels, 0 where one is unknown or where a depth's edge is. */
double depthAt(const cv::Mat& millimetres, const cv::Point2f& pixel);

//! The point nearest to all rays, or false if a camera would have it behind it or rays are nearly parallel.
bool triangulate(
        const std::vector<Pose>& poses, const std::vector<Eigen::Vector3d>& rays, Eigen::Vector3d& point);

}  // namespace iib_localization
