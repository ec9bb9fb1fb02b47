// SPDX-License-Identifier: Apache-2.0
#ifndef IIB_GEOMETRY_EPIPOLAR_LOSS_HPP
#define IIB_GEOMETRY_EPIPOLAR_LOSS_HPP

#include <vector>

#include "two_views.hpp"

namespace cv {
namespace iib {

/** Matches of two calibrated cameras, and how far they are from a pose: Cauchy's loss, the sum of log(1 + r^2) where r
is Sampson's error in pixels (Hartley and Zisserman 2004, equation 11.9) over the scale, and r^2 > FARTHEST counts as
FARTHEST: by how far a wrong match is wrong says nothing of the pose. */
class EpipolarLoss
{
public:
    typedef Vec<double, 5> Step;
    static const double FARTHEST;

    //! Both N x 2, CV_64F, pixels; matrices of cameras without skew; scale in pixels.
    EpipolarLoss(const Mat& points1, const Mat& points2, const Matx33d& camera1, const Matx33d& camera2,
            double scale);

    int size() const { return (int)first_.size(); }
    const Point2d& first(int i) const { return first_[i]; }    //!< direction in camera 1, third coordinate 1
    const Point2d& second(int i) const { return second_[i]; }  //!< the same in camera 2

    //! The loss, or anything over `limit` if it is over `limit`.
    double at(const Matx33d& essential, double limit) const;

    //! The loss where matches of points behind a camera count as FARTHEST too, which E does not tell.
    double at(const RelativePose& pose) const;

    //! Marks the matches at less than FARTHEST and in front of both cameras, and counts them.
    int inliers(const RelativePose& pose, std::vector<uchar>& mask) const;

    //! An error over the scale, and its derivatives by the numbers of `moved`.
    struct Row
    {
        double r;
        Step J;
    };

    //! The rows of the matches at less than FARTHEST.
    void linearize(const RelativePose& pose, std::vector<Row>& rows) const;

private:
    double squaredError(const Matx33d& essential, int i) const;  // r^2 of match i

    std::vector<Point2d> first_, second_;
    double weights_[4];  // of the four squares in Sampson's denominator: (scale / focal length)^2
};

}  // namespace iib
}  // namespace cv

#endif
