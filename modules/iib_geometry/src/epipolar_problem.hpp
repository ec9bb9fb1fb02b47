// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "robust_fit.hpp"
#include "two_views.hpp"

namespace cv::iib {

/** Matches of two calibrated cameras, whose relative pose is sought (robust_fit.hpp). The error of a match is Sampson's, in
pixels (Hartley and Zisserman 2004, equation 11.9), over the scale. */
class EpipolarProblem
{
public:
    typedef RelativePose Model;
    typedef Vec<double, 5> Step;

    //! Both N x 2, CV_64F, pixels; matrices of cameras without skew; scale in pixels.
    EpipolarProblem(const Mat& points1, const Mat& points2, const Matx33d& camera1, const Matx33d& camera2,
            double scale);

    int size() const { return (int)first_.size(); }
    int sampleSize() const { return 5; }
    int parameters() const { return 5; }

    //! The poses that see the sample in front of both cameras.
    void propose(const std::vector<int>& sample, std::vector<RelativePose>& poses) const;

    //! Blind to points behind a camera, which have an epipolar line all the same.
    double loss(const RelativePose& pose, double limit) const;

    double verdict(const RelativePose& pose) const;
    void linearize(const RelativePose& pose, std::vector<Row<Step>>& rows) const;
    RelativePose moved(const RelativePose& pose, const Step& step) const { return iib::moved(pose, step); }
    int inliers(const RelativePose& pose, std::vector<uchar>& mask) const;

private:
    double squaredError(const Matx33d& essential, int i) const;

    std::vector<Point2d> first_, second_;  // directions, third coordinate 1
    double weights_[4];  // of the four squares in Sampson's denominator: (scale / focal length)^2
};

}  // namespace cv::iib
