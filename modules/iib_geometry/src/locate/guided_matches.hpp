// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "../map/map.hpp"
#include "../pose/camera_pose.hpp"

namespace cv::iib {

//! An image and those of a map, as refinement looks at them.
struct Views
{
    const Map& map;
    PreparedPictures& pictures;  //!< of the map's images
    const PreparedPicture& own;
};

/** Moves the pixels of matches to where an image shows what the map's images show, and gives those the deviation REFINED.
@param least matches with an image of the map, for which it is done.
@return which were moved. */
std::vector<bool> refineAgainstViews(std::vector<Match>& matches, const Views& views, size_t least);

/** Points of some of a map's images near where a pose has them: where the image shows what that one does which sees the point at
the most similar size.
@param compared these images. @param frame of the pose. */
std::vector<Match> guidedMatches(const Views& views, const std::vector<size_t>& compared, const Lens& lens,
        const Frame& frame, const Affine3d& pose);

//! Gives the matches that were refined the deviation that they have of where a pose has their points.
void learnDeviation(std::vector<Match>& matches, const Lens& lens, const Affine3d& pose);

}  // namespace cv::iib
