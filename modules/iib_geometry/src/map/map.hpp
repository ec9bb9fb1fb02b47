// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "colmap_model.hpp"
#include "picture.hpp"

namespace cv::iib {

//! A straight edge in the world, directed as its segments are.
struct MapLine
{
    Point3d begin, end;
};

//! An image of a map; each of its keypoints sees a point, and the strongest keypoints come first.
struct MapImage : PosedImage
{
    std::vector<float> sizes;   //!< of its keypoints
    Mat codes;                  //!< N x bytes, CV_8U
    std::vector<uchar> misses;  //!< of each code: consecutive updates that expected it and did not find it
    uint32_t used = 0;          //!< number of the last update that matched the image
    bool added = false;         //!< by an update
    Picture picture;            //!< keypoints of other images are refined against it; may be empty
    std::vector<int> lines;     //!< indices of the lines that the image sees
    Mat lineCodes;              //!< LBD, one row a line
};

//! A map, in memory as on the disk.
struct Map
{
    int keypoints = 2000;      //!< to detect in an image
    bool orbAndAkaze = false;  //!< the paper's detectors and descriptor
    uint32_t updates = 0;      //!< number of updates so far
    std::vector<MapImage> images;
    std::vector<Point3d> points;
    std::vector<MapLine> lines;

    //! The points that an image's keypoints see.
    std::vector<Point3d> seenBy(const MapImage& image) const;
    //! Removes keypoints without a point, and points without a keypoint.
    void compact();
};

//! @throws cv::Exception for a folder without a map, or with a damaged one.
Map readMap(const std::string& folder);

//! As buildMap, in memory (mapping.cpp).
Map makeMap(const std::string& model, const ImageReader& images, const MapOptions& options,
        const MappingReport& report);

/** Estimates the map's own error by leave-one-out (map_error.cpp): the mean squared deviation of some images, located by the points that the others
triangulate, from their poses in the map. A few images do not span all directions, so an isotropic sample of their mean size is added.
@return covariance of a camera's centre, in units of the scene's distance, and of a rotation, both in the camera's axes;
zeros if no point is seen by three images. */
Matx66d mapError(const Map& map);

//! The map error in the world's axes. @param depth distance to the scene
Matx66d inWorld(const Matx66d& error, const Affine3d& cameraFromWorld, double depth);

/** Writes a map's file.
@param map does not change, but reading and writing have one code.
@param last called when the file is complete on the disk, before it replaces the old one. */
void writeMap(const std::string& folder, Map& map, const std::function<void()>& last);

}  // namespace cv::iib
