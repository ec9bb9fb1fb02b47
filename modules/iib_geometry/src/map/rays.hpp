// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "map.hpp"

namespace cv::iib {

//! A keypoint of an image, and where it is seen from and to in the world.
struct Ray
{
    size_t image;
    int keypoint;
    Vec3d centre, direction;
    double scale;    //!< pixels a radian
    int point = -1;  //!< that the keypoint sees already

    //! Pixels from where the keypoint's point would be seen.
    double error(const Vec3d& at) const;
};

//! The rays of an image's keypoints; NaN for those that its lens sees nothing at.
std::vector<Ray> raysOf(size_t number, const PosedImage& image);

//! Two rays, by their indices, that match.
struct RayMatch
{
    float bits;
    size_t a, b;
};

//! What matching of images gives.
struct MatchedRays
{
    std::vector<Ray> rays;        //!< of the images of all pairs
    std::vector<RayMatch> links;  //!< matches among what the images' poses have near each other
    //! Of matches of each image's strongest codes, and of those the ones that fit the poses: few if the poses are not those of the images.
    size_t matches = 0, fitting = 0;
};

//! Matches keypoints of pairs of images. @param step is called after each pair, by several threads.
MatchedRays matchPairs(
        const std::vector<MapImage>& images, const std::vector<std::pair<size_t, size_t>>& pairs,
        const std::function<void()>& step = [] {});

}  // namespace cv::iib
