// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <limits>

#include "opencv2/core.hpp"

namespace iib_tools {

//! Chances at which it is asked how many errors are inside.
const double LEVELS[] = {.1, .25, .5, .75, .9, .95, .99};

//! Chance that a sum of squares of so many normal numbers, two or three, is smaller.
inline double chanceOf(double squared, int freedom)
{
    const double rest = std::exp(-squared / 2);
    if (freedom == 2 || rest == 0)
        return 1 - rest;
    return std::erf(std::sqrt(squared / 2)) - std::sqrt(2 * squared / CV_PI) * rest;
}

//! How many standard deviations an error is off, squared: infinite where it is told that there is none.
template <int N> double squaredOf(const cv::Vec<double, N>& error, const cv::Matx<double, N, N>& covariance)
{
    cv::Vec<double, N> variances;
    cv::Matx<double, N, N> axes;
    cv::eigen(covariance, variances, axes);
    const cv::Vec<double, N> along = axes * error;
    double squared = 0;
    for (int k = 0; k < N; k++)
        if (along[k] != 0)
            squared += variances[k] > 0 ? along[k] * along[k] / variances[k]
                                        : std::numeric_limits<double>::infinity();
    return squared;
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
    const double sine = cv::norm(along), angle = std::atan2(sine, found.dot(truth));
    return sine > 0 ? along * (angle / sine) : cv::Vec2d(angle, 0);  // of the opposite one, whichever way
}

//! Turns of two cameras after which R = I, and t, of length 1, along the x axis.
struct Rectification
{
    cv::Matx33d first, second;
    cv::Vec3d t;
};

//! Of cameras with a way between them that is not the way they look. @param R, t from the first's axes to the second's
inline Rectification rectificationOf(const cv::Matx33d& R, const cv::Vec3d& t)
{
    const cv::Vec3d way = cv::normalize(-(R.t() * t)),
                    ahead = cv::Vec3d(0, 0, 1) + R.t() * cv::Vec3d(0, 0, 1);
    const double side = way[0] < 0 ? -1 : 1;
    const cv::Vec3d x = side * way, y = cv::normalize(ahead.cross(x)), z = x.cross(y);
    const cv::Matx33d turn(x[0], x[1], x[2], y[0], y[1], y[2], z[0], z[1], z[2]);
    return {turn, turn * R.t(), cv::Vec3d(-side, 0, 0)};
}

}  // namespace iib_tools
