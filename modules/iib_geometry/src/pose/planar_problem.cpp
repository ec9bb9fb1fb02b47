// SPDX-License-Identifier: Apache-2.0
#include "planar_problem.hpp"

#include "opencv2/iib/alignment.hpp"

namespace cv::iib {
namespace {

//! Matches between two checks of the limit; the product of their 1 + r^2 / scale^2 is at most 1e16.
const int STRIDE = 16;

//! Before the horizon, the determinant of the derivatives by a point has the sign of det T.
bool mirrors(const Matx33d& T) { return !(determinant(T) > 0); }

std::vector<Vec3d> transformed(const Points& points, const Matx33d& by)
{
    std::vector<Vec3d> result;
    for (const Point2d& p : points)
        result.push_back(by * Vec3d(p.x, p.y, 1));
    return result;
}

}  // namespace

PlanarProblem::PlanarProblem(const Points& reference, const Points& image, int kind)
    : entries_{{0, 0, 2, 1}, {1, 1, 2, 1}}
{
    if (kind == ALIGN_SIMILARITY)
        entries_.insert(entries_.end(), {{2, 0, 0, 1}, {2, 1, 1, 1}, {3, 0, 1, -1}, {3, 1, 0, 1}});
    if (kind >= ALIGN_AFFINE)
        entries_.insert(entries_.end(), {{2, 0, 0, 1}, {3, 0, 1, 1}, {4, 1, 0, 1}, {5, 1, 1, 1}});
    if (kind == ALIGN_HOMOGRAPHY)
        entries_.insert(entries_.end(), {{6, 2, 0, 1}, {7, 2, 1, 1}});
    if (image.empty())
        return;
    // one unit for both images, so that a translation stays a translation
    const Scalar from = mean(reference), to = mean(image);
    double spread = 1;
    for (const Point2d& p : image)
        spread = std::max(spread, norm(Vec2d(p.x - to[0], p.y - to[1])));
    fromReference_ = Matx33d(1 / spread, 0, -from[0] / spread, 0, 1 / spread, -from[1] / spread, 0, 0, 1);
    fromImage_ = Matx33d(1 / spread, 0, -to[0] / spread, 0, 1 / spread, -to[1] / spread, 0, 0, 1);
    reference_ = transformed(reference, fromReference_);
    image_ = transformed(image, fromImage_);
    unit_ = spread;
}

// T p = w r with T = 1 + sum of s_k G_k. Without w, each match gives two equations that are linear in s (Hartley and Zisserman
// 2004, section 4.1).
void PlanarProblem::propose(const std::vector<int>& sample, std::vector<Matx33d>& transforms) const
{
    transforms.clear();
    const int n = parameters();
    Mat A(n, n, CV_64F, Scalar(0)), b(n, 1, CV_64F), s;
    for (int i = 0; i < n; i++)
    {
        const Vec3d &p = image_[sample[i / 2]], &r = reference_[sample[i / 2]];
        const int c = i % 2;
        b.at<double>(i) = r[c] - p[c];
        for (const Entry& entry : entries_)
            if (entry.row == c || entry.row == 2)
                A.at<double>(i, entry.step) += entry.value * p[entry.column] * (entry.row == 2 ? -r[c] : 1);
    }
    if (!solve(A, b, s, DECOMP_LU))
        return;
    Step step;
    std::copy(s.ptr<double>(), s.ptr<double>() + n, step.val);
    const Matx33d transform = moved(Matx33d::eye(), step);
    if (mirrors(transform))
        return;
    for (int i : sample)
        if (!(squaredError(transform, i, i) < 1))
            return;  // beyond the horizon
    transforms.push_back(transform);
}

inline PlanarProblem::Place PlanarProblem::placeOf(const Matx33d& transform, const Vec3d& point) const
{
    const Vec3d q = transform * point;
    const double perW = 1 / q[2];
    Place place;
    place.at = Vec2d(q[0] / q[2], q[1] / q[2]);
    for (const Entry& entry : entries_)
    {
        const double by = entry.value * point[entry.column] * perW;
        if (entry.row < 2)
            place.byStep(entry.row, entry.step) += by;
        else
            for (int c = 0; c < 2; c++)
                place.byStep(c, entry.step) -= place.at[c] * by;
    }
    return place;
}

double PlanarProblem::squaredError(const Matx33d& T, int reference, int image) const
{
    const Vec3d q = T * image_[image];
    if (!(q[2] > 1e-6))
        return std::numeric_limits<double>::infinity();
    const double x = q[0] / q[2] - reference_[reference][0], y = q[1] / q[2] - reference_[reference][1];
    return unit_ * unit_ * (x * x + y * y);
}

double PlanarProblem::loss(const Matx33d& transform, const Loss& by, double limit) const
{
    if (mirrors(transform))
        return size() * std::log1p(by.farthest);
    const double perScale2 = 1 / square(by.scale);
    double sum = 0;
    for (int begin = 0; begin < size() && sum <= limit; begin += STRIDE)
    {
        double product = 1;
        for (int i = begin; i < std::min(begin + STRIDE, size()); i++)
            product *= 1 + std::min(squaredError(transform, i, i) * perScale2, by.farthest);
        sum += std::log(product);
    }
    return sum;
}

void PlanarProblem::squaredErrors(const Matx33d& transform, std::vector<double>& errors) const
{
    errors.assign(size(), std::numeric_limits<double>::infinity());
    if (mirrors(transform))
        return;
    for (int i = 0; i < size(); i++)
        errors[i] = squaredError(transform, i, i);
}

void PlanarProblem::linearize(const Matx33d& transform, double limit, std::vector<Row<Step>>& rows) const
{
    rows.clear();
    if (mirrors(transform))
        return;
    rows.reserve(2 * size());
    for (int i = 0; i < size(); i++)
    {
        const double r2 = squaredError(transform, i, i);
        if (!(r2 < limit))
            continue;
        const Place place = placeOf(transform, image_[i]);
        for (int c = 0; c < 2; c++)
        {
            rows.emplace_back();
            Row<Step>& row = rows.back();
            row.match = i;
            row.r = unit_ * (place.at[c] - reference_[i][c]);
            row.r2 = r2;
            for (int k = 0; k < Step::channels; k++)
                row.J[k] = unit_ * place.byStep(c, k);
        }
    }
}

Matx33d PlanarProblem::moved(const Matx33d& transform, const Step& step) const
{
    Matx33d result = transform;
    for (const Entry& entry : entries_)
        result(entry.row, entry.column) += entry.value * step[entry.step];
    return result;
}

Matx33d PlanarProblem::inPixels(const Matx33d& transform) const
{
    const Matx33d pixels = fromReference_.inv() * transform * fromImage_;
    return pixels * (1 / pixels(2, 2));
}

Matx33d PlanarProblem::fromPixels(const Matx33d& transform) const
{
    const Matx33d model = fromReference_ * transform * fromImage_.inv();
    return model * (1 / model(2, 2));
}

double PlanarProblem::deviation(
        const Matx33d& transform, const Square<Step>& covariance, const Point2d& pixel) const
{
    const Vec3d point = fromImage_ * Vec3d(pixel.x, pixel.y, 1);
    if (!((transform * point)[2] > 1e-6))
        return std::numeric_limits<double>::infinity();  // beyond the horizon
    const Place place = placeOf(transform, point);
    return std::sqrt(trace(place.byStep * covariance * place.byStep.t())) * unit_;
}

}  // namespace cv::iib
