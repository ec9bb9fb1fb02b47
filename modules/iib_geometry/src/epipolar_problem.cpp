// SPDX-License-Identifier: Apache-2.0
#include "epipolar_problem.hpp"

#include <algorithm>
#include <cmath>

#include "five_points.hpp"

namespace cv::iib {
namespace {

const int STRIDE = 32;          // matches between two looks at the limit
const double NOWHERE = 1e-300;  // keeps an error of 0 / 0, at the epipoles, finite

std::vector<Point2d> directions(const Mat& points, const Matx33d& camera)
{
    std::vector<Point2d> rays(points.rows);
    for (int i = 0; i < points.rows; i++)
    {
        const double* p = points.ptr<double>(i);
        rays[i] = Point2d((p[0] - camera(0, 2)) / camera(0, 0), (p[1] - camera(1, 2)) / camera(1, 1));
    }
    return rays;
}

double square(double x) { return x * x; }

}  // namespace

EpipolarProblem::EpipolarProblem(
        const Mat& points1, const Mat& points2, const Matx33d& camera1, const Matx33d& camera2, double scale)
    : first_(directions(points1, camera1)),
      second_(directions(points2, camera2)), weights_{square(scale / camera2(0, 0)),
                                                     square(scale / camera2(1, 1)),
                                                     square(scale / camera1(0, 0)),
                                                     square(scale / camera1(1, 1))}
{
}

double EpipolarProblem::squaredError(const Matx33d& E, int i) const
{
    const Point2d &u = first_[i], &v = second_[i];
    const double line0 = E(0, 0) * u.x + E(0, 1) * u.y + E(0, 2),
                 line1 = E(1, 0) * u.x + E(1, 1) * u.y + E(1, 2),
                 line2 = E(2, 0) * u.x + E(2, 1) * u.y + E(2, 2),
                 back0 = E(0, 0) * v.x + E(1, 0) * v.y + E(2, 0),
                 back1 = E(0, 1) * v.x + E(1, 1) * v.y + E(2, 1);
    const double error = v.x * line0 + v.y * line1 + line2;
    const double length2 = weights_[0] * line0 * line0 + weights_[1] * line1 * line1 +
                           weights_[2] * back0 * back0 + weights_[3] * back1 * back1;
    return error * error / (length2 + NOWHERE);
}

void EpipolarProblem::propose(const std::vector<int>& sample, std::vector<RelativePose>& poses) const
{
    Point2d first[5], second[5];
    for (int k = 0; k < 5; k++)
    {
        first[k] = first_[sample[k]];
        second[k] = second_[sample[k]];
    }
    poses.clear();
    std::vector<Matx33d> essentials;
    fivePointEssentials(first, second, essentials);
    for (const Matx33d& essential : essentials)
    {
        RelativePose four[4];
        posesOf(essential, four);
        for (const RelativePose& pose : four)
        {
            int k = 0;
            while (k < 5 && inFront(pose, first[k], second[k]))
                k++;
            if (k == 5)
                poses.push_back(pose);
        }
    }
}

double EpipolarProblem::loss(const RelativePose& pose, double limit) const
{
    const Matx33d essential = essentialOf(pose);
    double loss = 0;
    for (int begin = 0; begin < size() && loss <= limit; begin += STRIDE)
    {
        double product = 1;  // one logarithm for them
        for (int i = begin; i < std::min(begin + STRIDE, size()); i++)
            product *= 1 + std::min(squaredError(essential, i), FARTHEST);
        loss += std::log(product);
    }
    return loss;
}

double EpipolarProblem::verdict(const RelativePose& pose) const
{
    const Matx33d essential = essentialOf(pose);
    double loss = 0;
    for (int i = 0; i < size(); i++)
    {
        const double error = squaredError(essential, i);
        loss += std::log1p(error < FARTHEST && inFront(pose, first_[i], second_[i]) ? error : FARTHEST);
    }
    return loss;
}

int EpipolarProblem::inliers(const RelativePose& pose, std::vector<uchar>& mask) const
{
    const Matx33d essential = essentialOf(pose);
    int count = 0;
    for (int i = 0; i < size(); i++)
    {
        mask[i] = squaredError(essential, i) < FARTHEST && inFront(pose, first_[i], second_[i]);
        count += mask[i];
    }
    return count;
}

void EpipolarProblem::linearize(const RelativePose& pose, std::vector<Row<Step>>& rows) const
{
    rows.clear();
    const Matx33d E = essentialOf(pose), cross = crossProduct(pose.t);
    const Matx<double, 3, 2> tangents = tangentsOf(pose.t);
    Matx33d byStep[5];  // derivatives of E: [t]x [e]x R, and [b]x R
    for (int k = 0; k < 3; k++)
    {
        Vec3d axis;
        axis[k] = 1;
        byStep[k] = cross * crossProduct(axis) * pose.R;
    }
    for (int k = 0; k < 2; k++)
        byStep[3 + k] = crossProduct(Vec3d(tangents(0, k), tangents(1, k), tangents(2, k))) * pose.R;

    for (int i = 0; i < size(); i++)
    {
        const Vec3d u(first_[i].x, first_[i].y, 1), v(second_[i].x, second_[i].y, 1);
        const Vec3d line = E * u, back = E.t() * v;
        const Vec3d weightedLine(weights_[0] * line[0], weights_[1] * line[1], 0),
                weightedBack(weights_[2] * back[0], weights_[3] * back[1], 0);
        const double length2 = weightedLine.dot(line) + weightedBack.dot(back) + NOWHERE;
        const double inverse = 1 / std::sqrt(length2), r = v.dot(line) * inverse;
        if (r * r >= FARTHEST)
            continue;
        // dr = (v' dE u) / length - r (line' W dE u + back' W dE' v) / length^2: both are sums over dE's entries
        double byE[9];
        for (int k = 0; k < 9; k++)
            byE[k] =
                    (v[k / 3] * u[k % 3] -
                            r * inverse * (weightedLine[k / 3] * u[k % 3] + weightedBack[k % 3] * v[k / 3])) *
                    inverse;
        Row<Step> row;
        row.r = r;
        row.r2 = r * r;
        for (int k = 0; k < 5; k++)
        {
            row.J[k] = 0;
            for (int e = 0; e < 9; e++)
                row.J[k] += byE[e] * byStep[k].val[e];
        }
        rows.push_back(row);
    }
}

}  // namespace cv::iib
