// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "lens.hpp"

namespace cv::iib {

//! A point of the map and where it may be seen.
struct Match
{
    Point2d pixel;
    Point3d point;
    int number = 0;             //!< of the point
    int keypoint = 0;           //!< the image's
    int bits = 0;               //!< in which the codes differ
    int view = 0;               //!< image of the map that sees the point so
    int row = 0;                //!< of that image's codes
    Vec2f sizes = Vec2f(1, 1);  //!< at which that image and this one see it; their ratio counts
    double deviation = 1;       //!< of the pixel
    //! What of the pixel's error counts: all, or what is across a line.
    Matx22d errorProjection = Matx22d::eye();
};

//! The inverse of a rigid motion. Affine3d::inv() goes through an SVD, which far from the origin leaves no digit.
inline Affine3d inverse(const Affine3d& pose)
{
    const Matx33d back = pose.rotation().t();
    return {back, -(back * pose.translation())};
}

//! The median of numbers; 0 of none.
double median(std::vector<double> values);

//! How far two cameras are apart: the distance of their centres over that of what they see, plus the angle between their directions in radians.
double distance(const Affine3d& a, const Affine3d& b, double depth);

//! Axes in which points lie about the origin at distances of about 1, wherever and in whatever unit they are given.
struct Frame
{
    Vec3d centre;
    double unit = 1;

    explicit Frame(const std::vector<Match>& matches);
    Point3d toLocal(const Point3d& point) const;
    //! A camera from these axes, and from the world's.
    Affine3d toLocal(const Affine3d& cameraFromWorld) const;
    Affine3d toWorld(const Affine3d& cameraFromLocal) const;
    //! The covariance of a camera's centre and of a turn, from these axes to the world's.
    Matx66d toWorld(const Matx66d& covariance) const;
};

/** Camera from world that most matches agree on to `limit` pixels, not refined (USAC with MAGSAC's score). False if there is none.
@param matches in a Frame's axes. */
bool poseByRansac(const std::vector<Match>& matches, const Lens& lens, double limit, Affine3d& pose);

//! A match near a pose.
struct LinearMatch
{
    Vec2d error;                //!< of the match's pixel from where the pose has its point, pixels
    Matx<double, 2, 6> byPose;  //!< derivatives of that place by a step of the pose
    double weight = 0;          //!< by Cauchy's loss; 0 behind the camera
};

std::vector<LinearMatch> linearize(const std::vector<Match>& matches, const Lens& lens, const Affine3d& pose);

//! The pose whose centre moved and which turned about the world's axes: step holds the move (the map's unit) and the turn (rad).
Affine3d moved(const Affine3d& pose, const Vec6d& step);

/** Moves a pose to the least reprojection error with Cauchy's loss of a deviation, which cv::solvePnPRefineLM has not, by
reweighted least squares (Huber 1981, chapter 7).
@param matches in a Frame's axes.
@param covariance of the camera's centre and of a small turn about the world's axes, for errors of the matches' deviations.
@return false if the matches do not determine the pose. */
bool refinePose(const std::vector<Match>& matches, const Lens& lens, Affine3d& pose, Matx66d& covariance);

/** The covariance of a pose by the errors that its matches have, in place of those that refinePose assumed. Matches near each
other in the image, a cluster, err together, as the map does there: the more the gradients g of k clusters differ, the less certain is
the pose, by k / (k - 6) H^-1 (sum of g g') H^-1 (Liang and Zeger 1986), with H the curvature of the loss.
@param covariance of refinePose, which this replaces.
@return false if the matches do not determine the pose. */
bool clusteredCovariance(
        const std::vector<Match>& matches, const Lens& lens, const Affine3d& pose, Matx66d& covariance);

//! How far each match is from where a pose has its point, in pixels; NaN behind the camera.
std::vector<double> errorsOf(const std::vector<Match>& matches, const Lens& lens, const Affine3d& pose);

//! The matches within so many pixels of where a pose has their points.
std::vector<Match> within(
        double limit, const std::vector<Match>& matches, const Lens& lens, const Affine3d& pose);

//! Median distance of points in a camera's axes.
double medianDistance(const std::vector<Point3d>& points);

//! Of errors in the plane from their lengths, by their median as Rayleigh's distribution has it.
double deviationOf(const std::vector<double>& errors);

std::vector<Point3d> pointsOf(const std::vector<Match>& matches);

//! Where a pose has points of the world, in the camera's axes.
std::vector<Point3d> inCamera(const std::vector<Point3d>& points, const Affine3d& pose);

}  // namespace cv::iib
