// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include "opencv2/core.hpp"

namespace iib_tools {

//! Chances at which it is asked how many errors are inside.
const double LEVELS[] = {.1, .25, .5, .75, .9, .95, .99};

//! Chance that a sum of squares of so many normal numbers, two or three, is smaller.
inline double chanceOf(double squared, int freedom)
{
    const double two = 1 - std::exp(-squared / 2);
    return freedom == 2 ? two
                        : std::erf(std::sqrt(squared / 2)) -
                                  std::sqrt(2 * squared / CV_PI) * std::exp(-squared / 2);
}

//! How many standard deviations an error is off, squared.
template <int N> double squaredOf(const cv::Vec<double, N>& error, const cv::Matx<double, N, N>& covariance)
{
    return error.dot(covariance.inv(cv::DECOMP_SVD) * error);
}

//! The angles by which a direction errs, in the axes of findRelativePose's documentation.
inline cv::Vec2d alongTangents(const cv::Vec3d& found, const cv::Vec3d& truth)
{
    int shortest = 0;
    for (int k = 1; k < 3; k++)
        if (std::abs(found[k]) < std::abs(found[shortest]))
            shortest = k;
    cv::Vec3d axis;
    axis[shortest] = 1;
    const cv::Vec3d b = cv::normalize(found.cross(axis)), c = found.cross(b);
    const cv::Vec2d along(b.dot(truth), c.dot(truth));
    const double sine = cv::norm(along);
    return sine > 0 ? along * (std::atan2(sine, found.dot(truth)) / sine) : along;
}

}  // namespace iib_tools
