// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <numeric>

#include "../map/features.hpp"
#include "../map/lines.hpp"

namespace cv::iib {

constexpr size_t LEAST_INLIERS = 15;

//! What is found of an image, and what of the map showed it.
struct LocatedImage
{
    Location location;
    Features features;             //!< with the camera and, if it is found, the pose
    PreparedPicture prepared;      //!< of the features' picture, while a pose is looked for
    Segments segments;             //!< if lines refine the pose
    std::vector<size_t> compared;  //!< images of the map
    double depth = 0;              //!< median distance of what it sees
    std::vector<Match> agreeing;   //!< every code of the map that agrees, also several of one keypoint
};

/** Finds the pose that matches with points of a map agree on: by them, by what the map's images show along it, and by lines.
Then it judges whether it is one.
@param pictures of the map's images.
@param found has the image's features, its segments and the map's images that it was compared with. */
void findPose(const std::vector<Match>& matches, const Map& map, PreparedPictures& pictures,
        const Camera& camera, LocatedImage& found);

/** Number of keypoints that agree with the pose which agrees with most of the most similar matches.
@return 0 if there is no pose. */
int countInliers(const std::vector<Match>& matches, const Camera& camera);

//! What sorts first, of so many.
template <typename Before> std::vector<size_t> best(size_t all, size_t count, Before before)
{
    std::vector<size_t> order(all);
    std::iota(order.begin(), order.end(), size_t(0));
    std::stable_sort(order.begin(), order.end(), before);
    order.resize(std::min(all, count));
    return order;
}

}  // namespace cv::iib
