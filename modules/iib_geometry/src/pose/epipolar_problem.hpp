// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "robust_fit.hpp"
#include "two_views.hpp"

namespace cv::iib {

/** Matches of two calibrated cameras, whose relative pose is sought (robust_fit.hpp). The error of a match is Sampson's, in
pixels (Hartley and Zisserman 2004, equation 11.9). */
class EpipolarProblem
{
public:
    typedef RelativePose Model;
    typedef Vec<double, 5> Step;

    //! Both N x 2, CV_64F, pixels; matrices of cameras without skew.
    EpipolarProblem(const Mat& points1, const Mat& points2, const Matx33d& camera1, const Matx33d& camera2);

    //! Those of the matches that are marked.
    EpipolarProblem subset(const std::vector<bool>& marks) const;

    int size() const { return (int)first_.size(); }
    double mostScale() const { return mostScale_; }
    int sampleSize() const { return 5; }
    int parameters() const { return 5; }

    /** Matches among these that move like at least two others, at less than a tenth of the points' span from them. Right matches have such
    neighbours, wrong ones hardly any. At most 1000 are looked at. */
    std::vector<int> alikeTheirNeighbours(const std::vector<int>& matches) const;

    //! The poses that see the sample in front of both cameras.
    void propose(const std::vector<int>& sample, std::vector<RelativePose>& poses) const;

    //! Blind to points behind a camera, which have an epipolar line all the same.
    double loss(const RelativePose& pose, const Loss& by, double limit) const;

    //! Of a match behind a camera, as of a point at infinity, the nearest that may be.
    void squaredErrors(const RelativePose& pose, std::vector<double>& errors) const;
    /** The same of the first point of a match and the second point of another.
    @param essential that of the pose.
    @param farthest distance, pixels, from where on it does not count whether the match is behind a camera. */
    double squaredError(
            const RelativePose& pose, const Matx33d& essential, int first, int second, double farthest) const;
    //! How far a match is from where a point at infinity would be seen, pixels: as Sampson's error, a part of it in either image.
    double parallax(const RelativePose& pose, int first, int second) const;

    /** The same of all matches by the rotation under which those within a limit have the least parallax: a small turn looks like a move
    across the view.
    @param squared errors of the matches. */
    std::vector<double> leastParallaxes(
            const RelativePose& pose, const std::vector<double>& squared, double limit) const;

    //! What else the plane that most of the matches lie on may be seen from (Faugeras and Lustman 1988).
    std::vector<RelativePose> rivals(const RelativePose& pose, double scale) const;
    bool areApart(const RelativePose& pose, const RelativePose& other) const;
    void linearize(const RelativePose& pose, double limit, std::vector<Row<Step>>& rows) const;
    RelativePose moved(const RelativePose& pose, const Step& step) const { return iib::moved(pose, step); }

    /** The part of each row's J J' that noise of the points alone makes. A row whose derivatives by the direction of t may be noise alone, as
    of points without parallax or beside an epipole, has none by the direction. Rather too much is noise than too little.
    @param noise2 variance of a coordinate, pixels^2. */
    std::vector<Square<Step>> noiseInDerivatives(
            const RelativePose& pose, const std::vector<Row<Step>>& rows, double noise2) const;

private:
    struct Linear;
    Vec3d planeOf(const RelativePose& pose, double scale) const;
    Row<Step> row(const Linear& linear, const Point2d& first, const Point2d& second) const;

    std::vector<Point2d> first_, second_;  // directions, third coordinate 1
    double pixels_[4];                     // of v and of u: one over the focal lengths
    Vec4d weights_;                        // their squares, of the four squares in Sampson's denominator
    double mostScale_;
};

}  // namespace cv::iib
