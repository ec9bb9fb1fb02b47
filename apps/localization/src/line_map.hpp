// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "opencv2/core.hpp"

#include "geometry.hpp"

namespace iib_localization {

struct LineSight
{
    int keyframe;     //!< by index
    Segment segment;  //!< as seen, with distortion
};

//! A line segment in the world, directed as those of LineFeatures are.
struct MapLine
{
    Eigen::Vector3d begin, end;
    std::vector<LineSight> sights;  //!< of different keyframes
};

//! The lines of a map; those of a map without lines are empty.
struct LineMap
{
    std::vector<MapLine> lines;
    std::vector<cv::Mat> codes;  //!< [keyframe]: a row for each line that it sees, in the order of `lines`

    //! Lines and their codes in memory, in bytes.
    size_t bytes() const;
};

//! For each keyframe the lines that it sees, by index: what the rows of its codes belong to.
std::vector<std::vector<int>> linesOfKeyframes(const std::vector<MapLine>& lines, size_t keyframes);

//! Reads lines3D.txt. @throws cv::Exception for what is not as it should be.
std::vector<MapLine> readLines(const std::string& path, size_t keyframes);
void writeLines(const std::string& path, const std::vector<MapLine>& lines);

}  // namespace iib_localization
