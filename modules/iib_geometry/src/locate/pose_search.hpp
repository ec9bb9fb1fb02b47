// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <numeric>

#include "../map/features.hpp"
#include "../map/lines.hpp"

namespace cv::iib {

constexpr size_t LEAST_INLIERS = 15;

//! An image and the result of locating it.
struct LocatedImage
{
    Location location;
    MapImage features;             //!< with the camera and, if found, the pose
    PreparedPicture prepared;      //!< of the features' picture, during the search
    Segments segments;             //!< if lines refine the pose
    std::vector<size_t> compared;  //!< images of the map that it was matched with
    double depth = 0;              //!< median distance of its points
    std::vector<Match> agreeing;   //!< all inliers, also several of one keypoint
};

/** Estimates the pose from matches with points of a map, then from guided matches and lines, and accepts or rejects it.
@param pictures of the map's images.
@param found input: features, segments and compared images. Output: all else. */
void findPose(
        const std::vector<Match>& matches, const Map& map, PreparedPictures& pictures, LocatedImage& found);

//! Number of keypoints that agree with the RANSAC pose of the matches; 0 without a pose.
int countInliers(const std::vector<Match>& matches, const Camera& camera);

//! The first `count` of the indices below `all`, sorted by `before`.
template <typename Before> std::vector<size_t> best(size_t all, size_t count, Before before)
{
    std::vector<size_t> order(all);
    std::iota(order.begin(), order.end(), size_t(0));
    std::stable_sort(order.begin(), order.end(), before);
    order.resize(std::min(all, count));
    return order;
}

}  // namespace cv::iib
