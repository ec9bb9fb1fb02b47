// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "../common/points.hpp"
#include "lens.hpp"

namespace cv::iib {

//! A point of the map matched with a pixel of the image.
struct Match
{
    Point2d pixel;
    Point3d point;
    int number = 0;             //!< of the point in the map
    int keypoint = 0;           //!< index of the image's keypoint, -1 without one
    int bits = 0;               //!< number of differing bits of the two codes
    int view = 0;               //!< the map's image that the point was matched in
    int row = 0;                //!< of that image's codes
    Vec2f sizes = Vec2f(1, 1);  //!< of the point in that image and in this one; only their ratio counts
    double deviation = 1;       //!< standard deviation of the pixel
    bool isRefined = false;     //!< whether the pixel was refined against that image
    //! Projects the error; for line matches only its part perpendicular to the line.
    Matx22d errorProjection = Matx22d::eye();
};

//! The inverse of a rigid motion. Affine3d::inv() uses an SVD, which loses all digits far from the origin.
inline Affine3d inverse(const Affine3d& pose)
{
    const Matx33d back = pose.rotation().t();
    return {back, -(back * pose.translation())};
}

//! Distance of two cameras' centres over `depth`, plus the angle between their optical axes in radians.
double distance(const Affine3d& a, const Affine3d& b, double depth);

//! Normalized axes: the matches' points lie around the origin at distances of about 1.
struct Frame
{
    Vec3d centre;
    double unit = 1;

    explicit Frame(const std::vector<Match>& matches);
    Point3d toLocal(const Point3d& point) const;
    Affine3d toLocal(const Affine3d& cameraFromWorld) const;
    Affine3d toWorld(const Affine3d& cameraFromLocal) const;
    //! @param covariance of the camera's centre and of a small rotation.
    Matx66d toWorld(const Matx66d& covariance) const;
};

/** Estimates a pose by USAC with MAGSAC's score, and does not refine it. False if there is none.
@param matches in a Frame's axes.
@param limit inlier threshold, pixels.
@param pose receives camera from world. */
bool poseByRansac(const std::vector<Match>& matches, const Lens& lens, double limit, Affine3d& pose);

//! The linearized reprojection error of a match.
struct LinearMatch
{
    Vec2d error;                //!< the match's pixel less the point's projection, pixels
    Matx<double, 2, 6> byPose;  //!< derivatives of the projection by a step of the pose
    double weight = 0;          //!< by Cauchy's loss; 0 behind the camera
};

std::vector<LinearMatch> linearize(const std::vector<Match>& matches, const Lens& lens, const Affine3d& pose);

//! Changes a pose by a step: the motion of its centre (the map's unit), and a rotation vector about the world's axes (rad).
Affine3d moved(const Affine3d& pose, const Vec6d& step);

/** Minimizes the reprojection error under Cauchy's loss by reweighted least squares (Huber 1981, chapter 7).
cv::solvePnPRefineLM has neither a robust loss nor weights.
@param matches in a Frame's axes.
@param covariance of the camera's centre and of a small rotation about the world's axes. It assumes the matches' deviations.
@return false if the matches do not determine the pose. */
bool refinePose(const std::vector<Match>& matches, const Lens& lens, Affine3d& pose, Matx66d& covariance);

/** The covariance of a pose by its matches' measured errors; refinePose only assumes their size.

Matches near each other in the image have correlated errors, since the map is wrong there too. Such matches form a cluster. The
gradients g of k clusters and the curvature H of the loss give k / (k - 6) H^-1 (sum of g g') H^-1 (Liang and Zeger 1986).
@param covariance of refinePose, which this replaces.
@return false if the matches do not determine the pose. */
bool clusteredCovariance(
        const std::vector<Match>& matches, const Lens& lens, const Affine3d& pose, Matx66d& covariance);

//! Reprojection errors in pixels; NaN behind the camera.
std::vector<double> errorsOf(const std::vector<Match>& matches, const Lens& lens, const Affine3d& pose);

//! The matches with a reprojection error under `limit` pixels.
std::vector<Match> within(
        double limit, const std::vector<Match>& matches, const Lens& lens, const Affine3d& pose);

//! Median distance of points in a camera's axes.
double medianDistance(const std::vector<Point3d>& points);

//! Standard deviation per coordinate, from the median length of errors, as of Rayleigh's distribution.
double deviationOf(const std::vector<double>& errors);

//! Transforms points from the world's to the camera's axes.
std::vector<Point3d> inCamera(const std::vector<Point3d>& points, const Affine3d& pose);
std::vector<Point3d> inCamera(const std::vector<Match>& matches, const Affine3d& pose);

}  // namespace cv::iib
