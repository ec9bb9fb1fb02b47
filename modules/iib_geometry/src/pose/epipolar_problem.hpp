// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "robust_fit.hpp"
#include "two_views.hpp"

namespace cv::iib {

/** A Problem of robust_fit.hpp: the relative pose of two calibrated cameras. The error of a match is Sampson's, in pixels
(Hartley and Zisserman 2004, equation 11.9). */
class EpipolarProblem
{
public:
    typedef RelativePose Model;
    typedef Vec<double, 5> Step;

    //! Points in pixels; matrices of cameras without skew.
    EpipolarProblem(
            const Points& points1, const Points& points2, const Matx33d& camera1, const Matx33d& camera2);

    //! The same problem with the marked matches only.
    EpipolarProblem subset(const std::vector<bool>& marks) const;

    int size() const { return (int)first_.size(); }
    double mostScale() const { return mostScale_; }
    int sampleSize() const { return 5; }
    int parameters() const { return 5; }

    /** Matches among these that move like at least two neighbours, which are less than a tenth of the points' span away. Right matches have
    such neighbours, wrong ones hardly any. At most 1000 are compared. */
    std::vector<int> alikeTheirNeighbours(const std::vector<int>& matches) const;

    //! Keeps the poses for which the whole sample is in front of both cameras.
    void propose(const std::vector<int>& sample, std::vector<RelativePose>& poses) const;

    //! Does not penalize points behind a camera: they have an epipolar line too.
    double loss(const RelativePose& pose, const Loss& by, double limit) const;

    //! A match behind a camera gets the error of a point at infinity, if that is larger.
    void squaredErrors(const RelativePose& pose, std::vector<double>& errors) const;
    /** The same for the first point of one match and the second point of another.
    @param essential matrix of the pose.
    @param farthest pixels: beyond this error, the side of the camera is not checked. */
    double squaredError(
            const RelativePose& pose, const Matx33d& essential, int first, int second, double farthest) const;
    //! Parallax in pixels: the match's distance from a point at infinity, shared by both images as in Sampson's error.
    double parallax(const RelativePose& pose, int first, int second) const;
    std::vector<double> parallaxes(const RelativePose& pose) const;

    /** Parallaxes of all matches under the rotation that minimizes those of the matches within a limit. A small rotation can look
    like a sideways translation, and this removes that part.
    @param squared errors of the matches. */
    std::vector<double> leastParallaxes(
            const RelativePose& pose, const std::vector<double>& squared, double limit) const;

    //! The other poses that see the plane of most matches in the same way (Faugeras and Lustman 1988).
    std::vector<RelativePose> rivals(const RelativePose& pose, double scale) const;
    bool areApart(const RelativePose& pose, const RelativePose& other) const;
    void linearize(const RelativePose& pose, double limit, std::vector<Row<Step>>& rows) const;
    RelativePose moved(const RelativePose& pose, const Step& step) const { return iib::moved(pose, step); }

    /** The part of each row's J J' that comes from noise of the points, in the lower triangle. Derivatives by the direction of t
    may be noise only, for example without parallax or near an epipole; then all of that part counts as noise. The estimate errs
    on the large side.
    @param noise2 variance of a coordinate, pixels^2. */
    std::vector<Square<Step>> noiseInDerivatives(
            const RelativePose& pose, const std::vector<Row<Step>>& rows, double noise2) const;

private:
    struct Linear;
    Vec3d planeOf(const RelativePose& pose, double scale) const;
    Row<Step> row(const Linear& linear, const Point2d& first, const Point2d& second) const;

    Points first_, second_;  // directions, third coordinate 1
    double pixels_[4];       // size of a pixel: 1 / focal lengths, of camera 2, then of camera 1
    Vec4d weights_;          // their squares, which weight the four terms of Sampson's denominator
    double mostScale_;
};

}  // namespace cv::iib
