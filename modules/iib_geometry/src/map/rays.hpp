// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "map.hpp"

namespace cv::iib {

//! The viewing ray of a keypoint, in the world.
struct Ray
{
    size_t image;
    int keypoint;
    Vec3d centre, direction;
    double scale;    //!< pixels a radian
    int point = -1;  //!< number of the point that the keypoint already sees, or -1

    //! Distance of the ray from a point, in pixels.
    double error(const Vec3d& at) const;
};

//! The rays of an image's keypoints; NaN for pixels that its lens cannot see.
std::vector<Ray> raysOf(size_t number, const PosedImage& image);

//! Two matching rays, by index.
struct RayMatch
{
    float bits;
    uint32_t a, b;
};

//! Pairs of images, by index.
typedef std::vector<std::pair<size_t, size_t>> Pairs;

//! The result of matching pairs of images.
struct MatchedRays
{
    std::vector<Ray> rays;        //!< of all images in the pairs
    std::vector<RayMatch> links;  //!< matches guided by the poses
    //! Unguided matches of the strongest codes, and those that fit the poses: few if the poses are of other images.
    size_t matches = 0, consistent = 0;
};

//! Matches keypoints of pairs of images. @param step called after each pair, by several threads.
MatchedRays matchPairs(
        const std::vector<MapImage>& images, const Pairs& pairs, const std::function<void()>& step = [] {});

}  // namespace cv::iib
