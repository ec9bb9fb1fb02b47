// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "../common/points.hpp"

namespace cv::iib {

/** How many matches move as their neighbours do, by one affine map between the images. Right matches agree with their neighbours, also in a
scene with depth; wrong ones hardly ever do. */
struct Support
{
    int compared = 0;              //!< number of matches that were tested, a sample where there are many
    int count = 0;                 //!< of these, matches that agree with their neighbours
    Matx33d map = Matx33d::eye();  //!< affine, from points1 to points2, estimated from the matches that agree

    /** For matches of which few may be right.
    @param map an estimate, of which only the linear part is used.
    @param tolerance of a neighbour's displacement, relative to the displacement by the map. */
    static Support around(const Points& points1, const Points& points2, const Matx33d& map, double tolerance);

    //! For matches most of which are right, without an estimate of the map.
    static Support of(const Points& points1, const Points& points2);

    double share() const { return (double)count / std::max(compared, 1); }
};

/** Whether matches far from each other agree with the map of their neighbours. They do not where only small parts agree, such as windows that look
the same upside down.
@param map from points1 to points2, pixels, estimated from neighbours. */
bool agreeFarApart(const Points& points1, const Points& points2, const Matx33d& map);

/** Whether matches that a search found are of one structure alone, such as a round spot that looks like others in some view: they lie in few
regions of a descriptor's size.
@param points of the matches in a view, pixels. */
bool areOneStructure(const Points& points);

}  // namespace cv::iib
