// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "map.hpp"

namespace iib_localization {

//! A keypoint of an image, and where it is seen from and to in the world.
struct Ray
{
    size_t image;
    int keypoint;
    cv::Vec3d centre, direction;
    double scale;    //!< pixels a radian
    int point = -1;  //!< that the keypoint sees already

    //! Pixels from where the keypoint's point would be seen.
    double error(const cv::Vec3d& at) const;
};

//! The rays of an image's keypoints; NaN for those that its lens sees nothing at.
std::vector<Ray> raysOf(size_t number, const cv::iib::PosedImage& image);

//! Whether two rays lie in one plane with both cameras, and meet before them.
bool fitting(const Ray& a, const Ray& b);

//! Two rays, by their indices, that match.
struct Link
{
    float bits;
    size_t a, b;
};

/** The surest links first join rays to tracks, which hold one ray of an image and see one point at most. Gives those of two rays
or more. */
std::vector<std::vector<Ray>> joined(const std::vector<Ray>& rays, std::vector<Link> links);

/** Moves the keypoints of each track to what one of them shows, the reference: one that sees a point already, or that which looks
least differently from the others. Those that see a point stay. */
void refineTracks(std::vector<std::vector<Ray>>& tracks, std::vector<MapImage>& images);

/** The point of a track; the rays farthest from it are left out until the others agree.
@return false if too few agree, or look from nearly the same direction. */
bool place(std::vector<Ray>& track, cv::Point3d& point);

}  // namespace iib_localization
