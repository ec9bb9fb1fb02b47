// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "../test_precomp.hpp"
#include "common/points.hpp"
#include "pose/two_views.hpp"

namespace opencv_test {

using cv::iib::Points;
using cv::iib::RelativePose;

const Matx33d CAMERA(500, 0, 320, 0, 510, 240, 0, 0, 1);

inline RelativePose randomPose(RNG& random, double turn)
{
    Vec3d w, t;
    random.fill(w, RNG::UNIFORM, -turn, turn);
    random.fill(t, RNG::NORMAL, 0, 1);
    Vec<double, 5> step(w[0], w[1], w[2]);
    return cv::iib::moved({Matx33d::eye(), normalize(t)}, step);
}

//! A random pixel of an image, third coordinate 1.
inline Vec3d anyPixel(RNG& random)
{
    const double y = random.uniform(0., 480.), x = random.uniform(0., 640.);
    return {x, y, 1};
}

//! A random point in front of the first camera, at a depth of 4 to 12.
inline Vec3d anyPoint(RNG& random)
{
    const Vec3d ray = CAMERA.inv() * anyPixel(random);
    return random.uniform(4., 12.) * ray;
}

//! Projects a point to both images. @param noise standard deviation, pixels
inline void see(RNG& random, const RelativePose& pose, const Vec3d& X, double noise, Point2d& first,
        Point2d& second, double baseline = 1)
{
    const Vec3d a = CAMERA * X, b = CAMERA * (pose.R * X + baseline * pose.t);
    first.x = a[0] / a[2] + random.gaussian(noise);
    second.x = b[0] / b[2] + random.gaussian(noise);
    first.y = a[1] / a[2] + random.gaussian(noise);
    second.y = b[1] / b[2] + random.gaussian(noise);
}

/** Pixels of points in front of both cameras, at depths of 4 to 12 in camera 1.
@param wrong number of matches with a random second point. @param noise standard deviation, pixels. @param baseline length of t. */
struct Views
{
    Views(RNG& random, const RelativePose& pose, int count, int wrong, double noise, double baseline = 1)
    {
        while ((int)points1.size() < count)
        {
            const double depth = random.uniform(4., 12.);
            const Vec3d pixel = anyPixel(random);
            const Vec3d X = depth * (CAMERA.inv() * pixel), Y = pose.R * X + baseline * pose.t,
                        seen = CAMERA * Y;
            if (Y[2] < 1)
                continue;
            const bool isWrong = (int)points1.size() < wrong;
            Vec2d one, other;
            for (int k = 0; k < 2; k++)
            {
                one[k] = pixel[k] + random.gaussian(noise);
                other[k] = isWrong ? random.uniform(0., 480.) : seen[k] / seen[2] + random.gaussian(noise);
            }
            points1.push_back(one);
            points2.push_back(other);
        }
    }
    Points points1, points2;
};

//! The result of findRelativePose with CAMERA twice.
struct PoseResult
{
    RelativePose pose;
    Matx<double, 5, 5> covariance;
    Mat inliers;
    String reason;
    bool found;

    PoseResult(InputArray points1, InputArray points2, double scale = 0, const Matx33d& camera1 = CAMERA,
            const Matx33d& camera2 = CAMERA)
        : found(cv::iib::findRelativePose(
                  points1, points2, camera1, camera2, pose.R, pose.t, inliers, scale, covariance, &reason))
    {
    }
    explicit PoseResult(const Views& views, double scale = 0)
        : PoseResult(views.points1, views.points2, scale)
    {
    }

    //! The step from the pose to the true one.
    Vec<double, 5> error(const RelativePose& truth) const { return stepBetween(pose, truth); }
    //! The error's squared Mahalanobis length.
    double squared(const RelativePose& truth) const
    {
        return error(truth).dot(covariance.inv() * error(truth));
    }
    Matx22d ofDirection() const { return covariance.get_minor<2, 2>(3, 3); }
    //! Whether the true direction of t is inside the region of 95 %.
    bool hasDirection(const RelativePose& truth) const
    {
        const Vec2d off(error(truth).val + 3);
        return off.dot(ofDirection().inv() * off) < 5.99;
    }
};

//! Random points of an image.
inline Points anywhere(RNG& random, int count, double width, double height)
{
    Points points(count);
    for (double Point2d::*axis : {&Point2d::x, &Point2d::y})
        for (Point2d& point : points)
            point.*axis = random.uniform(0., axis == &Point2d::x ? width : height);
    return points;
}

}  // namespace opencv_test
