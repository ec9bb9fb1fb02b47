// SPDX-License-Identifier: Apache-2.0
#include "two_views.hpp"

#include <algorithm>
#include <cmath>

#include "opencv2/core/affine.hpp"

namespace cv::iib {
namespace {

Vec3d row(const Matx33d& m, int r) { return Vec3d(m(r, 0), m(r, 1), m(r, 2)); }

//! Makes a nearly orthonormal matrix a rotation (Gram and Schmidt).
Matx33d orthonormal(const Matx33d& m)
{
    const Vec3d x = normalize(row(m, 0)), y = normalize(row(m, 1) - x * x.dot(row(m, 1))), z = x.cross(y);
    return Matx33d(x[0], x[1], x[2], y[0], y[1], y[2], z[0], z[1], z[2]);
}

//! Rodrigues' formula. Affine3d's has other last digits, which decide between the two poses of a plane.
Matx33d rotationBy(const Vec3d& w)
{
    const double angle = norm(w);
    const double sine = angle > 1e-8 ? std::sin(angle) / angle : 1;
    const double versine = angle > 1e-8 ? (1 - std::cos(angle)) / (angle * angle) : .5;
    const Matx33d cross = crossProduct(w);
    return Matx33d::eye() + sine * cross + versine * (cross * cross);
}

}  // namespace

Matx<double, 3, 2> tangentsOf(const Vec3d& t)
{
    int shortest = 0;
    for (int k = 1; k < 3; k++)
        if (std::abs(t[k]) < std::abs(t[shortest]))
            shortest = k;
    Vec3d axis;
    axis[shortest] = 1;
    const Vec3d b = normalize(t.cross(axis)), c = t.cross(b);
    return Matx<double, 3, 2>(b[0], c[0], b[1], c[1], b[2], c[2]);
}

RelativePose moved(const RelativePose& pose, const Vec<double, 5>& step)
{
    const Vec3d along = tangentsOf(pose.t) * Vec2d(step[3], step[4]);
    return {orthonormal(rotationBy(Vec3d(step.val)) * pose.R), normalize(pose.t + along)};
}

Vec<double, 5> stepBetween(const RelativePose& pose, const RelativePose& other)
{
    const Vec3d turn = Affine3d(other.R * pose.R.t()).rvec();
    Vec2d along = tangentsOf(pose.t).t() * other.t;
    const double sine = norm(along), angle = std::atan2(sine, pose.t.dot(other.t));
    along = sine > 0 ? along * (angle / sine) : Vec2d(angle, 0);  // opposite directions have no sine
    return Vec<double, 5>(turn[0], turn[1], turn[2], along[0], along[1]);
}

// A step turns R to exp(w) R and t to t + B a, with the tangents B. The inverse pose, R' and -R't, then has the rotation
// R' exp(-w) = exp(-R'w) R', and to first order the translation -R't - R'(B a + t x w).
Matx<double, 5, 5> stepOfInverse(const RelativePose& pose)
{
    const Matx33d back = pose.R.t() * -1.;
    const Matx<double, 2, 3> along = tangentsOf(inverse(pose).t).t() * back;
    Matx<double, 5, 5> all;
    setBlock(all, 0, 0, back);
    setBlock(all, 3, 0, along * crossProduct(pose.t));
    setBlock(all, 3, 3, along * tangentsOf(pose.t));
    return all;
}

// Horn, Recovering baseline and orientation from essential matrix, 1990. With E = [t]x R, t t' = tr(EE')/2 - EE'. The matrix of
// cofactors is t t' R, so R t't = cofactors - [t]x E. The other rotation comes from -t.
void posesOf(const Matx33d& essential, RelativePose (&poses)[4])
{
    const Matx33d square = essential * essential.t();
    const double length2 = .5 * trace(square);
    int longest = 0;
    for (int k = 1; k < 3; k++)
        if (square(k, k) < square(longest, longest))
            longest = k;
    Vec3d t = -Vec3d(square(0, longest), square(1, longest), square(2, longest));
    t[longest] += length2;
    t *= std::sqrt(length2) / norm(t);
    Matx33d cofactors;
    for (int r = 0; r < 3; r++)
    {
        const Vec3d product = row(essential, (r + 1) % 3).cross(row(essential, (r + 2) % 3));
        std::copy(product.val, product.val + 3, cofactors.val + 3 * r);
    }
    const Matx33d rest = crossProduct(t) * essential;
    const Matx33d rotations[] = {orthonormal(cofactors - rest), orthonormal(cofactors + rest)};
    for (int k = 0; k < 4; k++)
        poses[k] = {rotations[k / 2], normalize(k % 2 ? -t : t)};
}

bool inFront(const RelativePose& pose, const Point2d& first, const Point2d& second)
{
    const Vec3d u = pose.R * Vec3d(first.x, first.y, 1), v(second.x, second.y, 1), normal = u.cross(v);
    return normal.dot(v.cross(pose.t)) > 0 && normal.dot(u.cross(pose.t)) > 0;
}

}  // namespace cv::iib
