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

//! An image of a map; each of its keypoints sees a point, and the strongest come first.
struct MapImage : PosedImage
{
    std::vector<float> sizes;   //!< of its keypoints
    Mat codes;                  //!< N x bytes, CV_8U
    std::vector<uchar> misses;  //!< of each code: updates in a row that looked for it and did not find it
    uint32_t used = 0;          //!< the last update in which the image helped
    bool added = false;         //!< by an update
    Picture picture;            //!< that keypoints of other images are refined against; may be empty
    std::vector<int> lines;     //!< that the image sees
    Mat lineCodes;              //!< LBD, a row each
};

//! A map, in memory as on the disk.
struct Map
{
    int keypoints = 2000;      //!< that are looked for in an image
    bool orbAndAkaze = false;  //!< the paper's points and descriptor
    uint32_t updates = 0;      //!< so far
    std::vector<MapImage> images;
    std::vector<Point3d> points;
    std::vector<MapLine> lines;  //!< none in a map that was made without

    //! The points that an image's keypoints see.
    std::vector<Point3d> seenBy(const MapImage& image) const;
    //! Removes keypoints that see no point, and points that nothing sees.
    void compact();
};

//! @throws cv::Exception for a folder without a map, or a damaged one.
Map readMap(const std::string& folder);

/** Writes a map's file.
@param last is called when all of it is on the disk, before it takes the place of the old one. */
void writeMap(const std::string& folder, const Map& map, const std::function<void()>& last);

}  // namespace cv::iib
