// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <vector>

#include "opencv2/core.hpp"

namespace cv::iib {

/** Matches whose neighbours move as one affine map between the images has it. Neighbouring right matches agree about the map, also of a
scene that is not flat; wrong ones hardly ever do. */
struct Support
{
    int compared = 0;              //!< matches: all, or some where there are many
    int count = 0;                 //!< of them, that are supported
    Matx33d map = Matx33d::eye();  //!< affine, from points1 to points2: estimated from the matches that agree

    /** Of matches of which few may be right.
    @param map roughly; of it only the derivative counts.
    @param tolerance of a neighbour's displacement from that, in parts of it. */
    static Support around(const std::vector<Point2d>& points1, const std::vector<Point2d>& points2,
            const Matx33d& map, double tolerance);

    //! Of matches most of which are right, between which any affine map may lead.
    static Support of(const std::vector<Point2d>& points1, const std::vector<Point2d>& points2);

    double share() const { return (double)count / std::max(compared, 1); }
};

/** Whether matches far from each other lie as the map of neighbours has it. Else neighbours agree in small parts alone: where windows look the same
upside down, or in a cluster beside which others agree by chance.
@param map from points1 to points2, pixels, estimated from neighbours. */
bool agreeFarApart(
        const std::vector<Point2d>& points1, const std::vector<Point2d>& points2, const Matx33d& map);

/** Whether matches that a search found are of one structure of an image alone, such as a round spot, which looks like others in some view:
whether they lie in few regions as large as one that is described.
@param points of the matches in a view, pixels. */
bool areOneStructure(const std::vector<Point2d>& points);

}  // namespace cv::iib
