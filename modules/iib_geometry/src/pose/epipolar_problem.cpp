// SPDX-License-Identifier: Apache-2.0
#include "epipolar_problem.hpp"

#include <algorithm>
#include <cmath>

#include "../precomp.hpp"
#include "five_points.hpp"
#include "../common/points.hpp"

namespace cv::iib {
namespace {

const int STRIDE = 32;          // matches between two checks of the limit
const double MOST_SCALE = .01;  // of the points' span: at wider scales, wrong poses fit as well as right ones
const double NOWHERE = 1e-300;  // avoids 0 / 0 at the epipoles
const int STEPS = 6;            // five parameters, padded to an even number for vectorization

Points directions(Points points, const Matx33d& camera)
{
    for (Point2d& p : points)
        p = {(p.x - camera(0, 2)) / camera(0, 0), (p.y - camera(1, 2)) / camera(1, 1)};
    return points;
}

//! The rotation that best turns the first directions to the second ones, weighted (Kabsch 1976).
template <class WeightOf>
Matx33d rotationBetween(const Point2d* first, const Point2d* second, int count, const WeightOf& weightOf)
{
    Matx33d products = Matx33d::zeros(), U, Vt;
    for (int k = 0; k < count; k++)
        products += weightOf(k) * normalize(Vec3d(second[k].x, second[k].y, 1)) *
                    normalize(Vec3d(first[k].x, first[k].y, 1)).t();
    Vec3d values;
    SVD::compute(products, values, U, Vt);
    return U * Matx33d::diag(Vec3d(1, 1, determinant(U * Vt))) * Vt;
}

//! Inline, and called with local copies, so that compilers vectorize loops over matches.
inline double squaredErrorOf(const Matx33d& E, const Vec4d& weights, const Point2d& u, const Point2d& v)
{
    const double line0 = E(0, 0) * u.x + E(0, 1) * u.y + E(0, 2),
                 line1 = E(1, 0) * u.x + E(1, 1) * u.y + E(1, 2),
                 line2 = E(2, 0) * u.x + E(2, 1) * u.y + E(2, 2),
                 back0 = E(0, 0) * v.x + E(1, 0) * v.y + E(2, 0),
                 back1 = E(0, 1) * v.x + E(1, 1) * v.y + E(2, 1);
    const double error = v.x * line0 + v.y * line1 + line2;
    const double length2 = weights[0] * line0 * line0 + weights[1] * line1 * line1 +
                           weights[2] * back0 * back0 + weights[3] * back1 * back1;
    return error * error / (length2 + NOWHERE);
}

}  // namespace

EpipolarProblem::EpipolarProblem(
        const Points& points1, const Points& points2, const Matx33d& camera1, const Matx33d& camera2)
    : first_(directions(points1, camera1)),
      second_(directions(points2, camera2)), pixels_{1 / camera2(0, 0), 1 / camera2(1, 1), 1 / camera1(0, 0),
                                                     1 / camera1(1, 1)}
{
    std::transform(pixels_, pixels_ + 4, weights_.val, square);
    const Rect2d span = spanOf(points2);
    mostScale_ = MOST_SCALE * std::hypot(span.width, span.height);
}

EpipolarProblem EpipolarProblem::subset(const std::vector<bool>& marks) const
{
    EpipolarProblem chosen = *this;
    chosen.first_.clear();
    chosen.second_.clear();
    for (size_t i = 0; i < marks.size(); i++)
        if (marks[i])
        {
            chosen.first_.push_back(first_[i]);
            chosen.second_.push_back(second_[i]);
        }
    return chosen;
}

std::vector<int> EpipolarProblem::alikeTheirNeighbours(const std::vector<int>& matches) const
{
    const double farthest = .1, nearest = .01;  // of the span; nearer matches are often wrong together
    const double unlike = .5;  // largest difference of two displacements, over the distance of the matches
    const int enough = 2;
    const size_t most = 1000;  // matches: more take time
    std::vector<int> order, counts(size());
    for (size_t i = 0, step = (matches.size() + most - 1) / most; i < matches.size(); i += step)
        order.push_back(matches[i]);
    std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return first_[a].x < first_[b].x; });
    const auto [top, bottom] = std::minmax_element(
            order.begin(), order.end(), [&](int a, int b) { return first_[a].y < first_[b].y; });
    const double span = order.empty() ? 0
                                      : std::hypot(first_[*bottom].y - first_[*top].y,
                                                first_[order.back()].x - first_[order[0]].x);
    for (size_t a = 0; a < order.size(); a++)
        for (size_t b = a + 1; b < order.size(); b++)
        {
            const int i = order[a], k = order[b];
            const Point2d way = first_[k] - first_[i], change = second_[k] - second_[i] - way;
            if (way.x > farthest * span)
                break;
            const double way2 = way.ddot(way);
            const int alike =
                    int(way2 > square(nearest * span)) & int(way2 < square(farthest * span)) &
                    int(change.ddot(change) < square(unlike) * way2);  // not &&: branches take longer
            counts[i] += alike;
            counts[k] += alike;
        }
    order.erase(std::remove_if(order.begin(), order.end(), [&](int i) { return counts[i] < enough; }),
            order.end());
    return order;
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
    if (essentials.empty())  // for example without parallax: any t explains the sample
        poses.push_back({rotationBetween(first, second, 5, [](int) { return 1.; }), Vec3d(0, 0, 1)});
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

double EpipolarProblem::loss(const RelativePose& pose, const Loss& by, double limit) const
{
    const Matx33d essential = essentialOf(pose);
    const Vec4d weights = weights_;
    const Point2d *const first = first_.data(), *const second = second_.data();
    const double perScale2 = 1 / square(by.scale);
    double loss = 0;
    for (int begin = 0; begin < size() && loss <= limit; begin += STRIDE)
    {
        double shares[STRIDE], product = 1;
        const int count = std::min(STRIDE, size() - begin);
        for (int i = 0; i < count; i++)
            shares[i] = squaredErrorOf(essential, weights, first[begin + i], second[begin + i]) * perScale2;
        for (int i = 0; i < count; i++)
            product *= 1 + std::min(shares[i], by.farthest);
        loss += std::log(product);
    }
    return loss;
}

double EpipolarProblem::squaredError(
        const RelativePose& pose, const Matx33d& essential, int first, int second, double farthest) const
{
    const double squared = squaredErrorOf(essential, weights_, first_[first], second_[second]);
    return squared > square(farthest) || inFront(pose, first_[first], second_[second])
                   ? squared
                   : std::max(squared, square(parallax(pose, first, second)));
}

void EpipolarProblem::squaredErrors(const RelativePose& pose, std::vector<double>& errors) const
{
    const Matx33d essential = essentialOf(pose);
    errors.resize(size());
    for (int i = 0; i < size(); i++)
        errors[i] = squaredError(pose, essential, i, i, std::numeric_limits<double>::max());
}

double EpipolarProblem::parallax(const RelativePose& pose, int first, int second) const
{
    const Vec3d far = pose.R * Vec3d(first_[first].x, first_[first].y, 1);
    return far[2] > 0 ? std::sqrt(square(far[0] / far[2] - second_[second].x) / (weights_[0] + weights_[2]) +
                                  square(far[1] / far[2] - second_[second].y) / (weights_[1] + weights_[3]))
                      : std::numeric_limits<double>::infinity();
}

std::vector<double> EpipolarProblem::parallaxes(const RelativePose& pose) const
{
    std::vector<double> all;
    for (int i = 0; i < size(); i++)
        all.push_back(parallax(pose, i, i));
    return all;
}

std::vector<double> EpipolarProblem::leastParallaxes(
        const RelativePose& pose, const std::vector<double>& squared, double limit) const
{
    const int rounds = 5;
    RelativePose turned = pose;
    for (int round = 0; round < rounds; round++)
    {
        const std::vector<double> all = parallaxes(turned);
        turned.R = rotationBetween(first_.data(), second_.data(), size(),
                [&](int i) { return squared[i] < square(limit) ? 1 / (square(limit) + square(all[i])) : 0; });
    }
    return parallaxes(turned);
}

//! The essential matrix of a pose and its derivatives.
struct EpipolarProblem::Linear
{
    Matx33d E;
    double byStep[9][STEPS] = {};  //!< of E's entries: [t]x [e]x R for rotations, [b]x R for translations

    explicit Linear(const RelativePose& pose) : E(essentialOf(pose))
    {
        const Matx33d cross = crossProduct(pose.t);
        const Matx<double, 3, 2> tangents = tangentsOf(pose.t);
        for (int k = 0; k < 5; k++)
        {
            const Vec3d axis(k < 3 ? Matx33d::eye().col(k).val : tangents.col(k - 3).val);
            const Matx33d changes = k < 3 ? cross * crossProduct(axis) * pose.R : crossProduct(axis) * pose.R;
            for (int e = 0; e < 9; e++)
                byStep[e][k] = changes.val[e];
        }
    }
};

Row<EpipolarProblem::Step> EpipolarProblem::row(
        const Linear& linear, const Point2d& first, const Point2d& second) const
{
    const double u[] = {first.x, first.y, 1}, v[] = {second.x, second.y, 1};
    const Matx33d& E = linear.E;
    double line[3], back[2];
    for (int k = 0; k < 3; k++)
        line[k] = E(k, 0) * u[0] + E(k, 1) * u[1] + E(k, 2);
    for (int k = 0; k < 2; k++)
        back[k] = E(0, k) * v[0] + E(1, k) * v[1] + E(2, k);
    const double weightedLine[] = {weights_[0] * line[0], weights_[1] * line[1], 0},
                 weightedBack[] = {weights_[2] * back[0], weights_[3] * back[1], 0};
    const double length2 = weightedLine[0] * line[0] + weightedLine[1] * line[1] + weightedBack[0] * back[0] +
                           weightedBack[1] * back[1] + NOWHERE;
    const double inverse = 1 / std::sqrt(length2), r = (v[0] * line[0] + v[1] * line[1] + line[2]) * inverse;
    // dr = (v' dE u) / length - r (line' W dE u + back' W dE' v) / length^2; both terms are sums over dE's entries
    const double pull = r * inverse;
    double J[STEPS] = {};
    for (int a = 0; a < 3; a++)
        for (int b = 0; b < 3; b++)
        {
            const double byE =
                    (v[a] * u[b] - pull * (weightedLine[a] * u[b] + weightedBack[b] * v[a])) * inverse;
            for (int k = 0; k < STEPS; k++)  // contiguous, so that compilers vectorize the loop
                J[k] += byE * linear.byStep[3 * a + b][k];
        }
    Row<Step> row;
    row.r = r;
    row.r2 = r * r;
    std::copy(J, J + 5, row.J.val);
    return row;
}

/** The plane that most matches lie on under a pose: a vector n with n' X = 1 for its points X, in units of t. So R + t n' is its
homography (Hartley and Zisserman 2004, section 13.1). Samples of three matches propose planes. The error of a match is the
distance of its point from the plane, in pixels as in Sampson's error. */
Vec3d EpipolarProblem::planeOf(const RelativePose& pose, double scale) const
{
    struct Seen
    {
        Vec3d ray;
        double nearness, pixels;  // 1 / depth, and the point's motion in pixels for a change of 1 in it
    };
    const int trials = 50;
    const double farthest2 = FARTHEST * square(scale);
    const Matx33d essential = essentialOf(pose);
    std::vector<Seen> all;
    for (int i = 0; i < size(); i++)
    {
        if (!(squaredErrorOf(essential, weights_, first_[i], second_[i]) < farthest2))
            continue;
        const Vec3d u(first_[i].x, first_[i].y, 1), v(second_[i].x, second_[i].y, 1),
                turned = pose.R * u, across = v.cross(pose.t);
        const double nearness = -across.dot(v.cross(turned)) / (across.dot(across) + NOWHERE),
                     depth = turned[2] + nearness * pose.t[2];
        const Vec3d moves = pose.t - v * pose.t[2];
        all.push_back({u, nearness,
                std::hypot(moves[0], moves[1]) / std::abs(depth) / std::sqrt(weights_[0] + weights_[2])});
    }
    const auto distance2 = [](const Seen& seen, const Vec3d& plane) {
        return square((seen.nearness - plane.dot(seen.ray)) * seen.pixels);
    };
    Vec3d best;
    double leastSum = std::numeric_limits<double>::infinity();
    RNG random(0x5eed);
    for (int trial = 0; trial < trials && all.size() >= 4; trial++)
    {
        Matx33d rays;
        Vec3d nearness, plane;
        for (int k = 0; k < 3; k++)
        {
            const Seen& seen = all[random.uniform(0, (int)all.size())];
            for (int c = 0; c < 3; c++)
                rays(k, c) = seen.ray[c];
            nearness[k] = seen.nearness;
        }
        if (!solve(rays, nearness, plane, DECOMP_LU))
            continue;
        double sum = 0;
        for (size_t i = 0; i < all.size() && sum < leastSum; i++)
            sum += std::min(distance2(all[i], plane), farthest2);
        if (sum < leastSum)
        {
            leastSum = sum;
            best = plane;
        }
    }
    Matx33d products = Matx33d::zeros();
    Vec3d right;
    for (const Seen& seen : all)
        if (distance2(seen, best) < farthest2)
        {
            products += square(seen.pixels) * (seen.ray * seen.ray.t());
            right += square(seen.pixels) * seen.nearness * seen.ray;
        }
    Vec3d refined;
    return solve(products, right, refined, DECOMP_CHOLESKY) ? refined : best;
}

std::vector<RelativePose> EpipolarProblem::rivals(const RelativePose& pose, double scale) const
{
    const Matx33d homography = pose.R + pose.t * planeOf(pose, scale).t();
    const double mostOff = .1;  // of R R' from 1: a degenerate homography gives no rotations
    std::vector<Mat> rotations, translations, normals;
    std::vector<RelativePose> poses;
    if (!checkRange(homography))
        return poses;
    decomposeHomographyMat(homography, Matx33d::eye(), rotations, translations, normals);
    for (size_t k = 0; k < rotations.size(); k++)
    {
        const Vec3d t(translations[k]);
        const Matx33d R(rotations[k]);
        if (!(norm(R * R.t() - Matx33d::eye()) < mostOff && norm(t) > NOWHERE))
            continue;
        const RelativePose other = moved({R, t * (1 / norm(t))}, Step());  // makes R orthonormal
        if (areApart(pose, other) && areApart(pose, {other.R, -other.t}))
            poses.push_back(other);
    }
    return poses;
}

bool EpipolarProblem::areApart(const RelativePose& pose, const RelativePose& other) const
{
    const double turned = .02, moved = .1;  // radians
    const Step between = stepBetween(pose, other);
    return norm(Vec3d(between.val)) > turned || norm(Vec2d(between.val + 3)) > moved;
}

void EpipolarProblem::linearize(const RelativePose& pose, double limit, std::vector<Row<Step>>& rows) const
{
    rows.clear();
    rows.reserve(size());
    const Linear linear(pose);
    const Matx33d essential = linear.E;
    const Vec4d weights = weights_;
    const Point2d *const first = first_.data(), *const second = second_.data();
    for (int begin = 0; begin < size(); begin += STRIDE)
    {
        double errors[STRIDE];
        const int count = std::min(STRIDE, size() - begin);
        for (int i = 0; i < count; i++)
            errors[i] = squaredErrorOf(essential, weights, first[begin + i], second[begin + i]);
        for (int i = 0; i < count; i++)
            if (errors[i] < limit)
            {
                rows.push_back(row(linear, first[begin + i], second[begin + i]));
                rows.back().match = begin + i;
            }
    }
}

std::vector<Square<EpipolarProblem::Step>> EpipolarProblem::noiseInDerivatives(
        const RelativePose& pose, const std::vector<Row<Step>>& rows, double noise2) const
{
    const double little = .01;  // pixels: step of the finite differences
    const double most = 2;      // times the mean square of the noise; noise alone seldom exceeds it
    const double more = 1 + 2 * std::sqrt(2. / std::max<double>((double)rows.size(), 1));
    const Linear linear(pose);
    std::vector<Square<Step>> all;
    all.reserve(rows.size());
    for (const Row<Step>& r : rows)
    {
        Square<Step> noise = Square<Step>::zeros();
        for (int coordinate = 0; coordinate < 4; coordinate++)
        {
            Point2d first = first_[r.match], second = second_[r.match];
            double* const moved[] = {&second.x, &second.y, &first.x, &first.y};
            *moved[coordinate] += little * pixels_[coordinate];
            addProduct(row(linear, first, second).J - r.J, noise2 / square(little) * more, noise);
        }
        const double left =
                1 - most * (noise(3, 3) + noise(4, 4)) / (square(r.J[3]) + square(r.J[4]) + NOWHERE);
        // The shares of the row and of its noise that stay, for entries with 0, 1 or 2 parameters of the direction.
        const double shares[] = {1, std::sqrt(std::max(left, 0.)), std::max(left, 0.)}, kept[] = {1, .5, .25};
        for (int a = 0; a < Step::channels; a++)
            for (int b = 0; b <= a; b++)
            {
                const int directions = (a > 2) + (b > 2);
                const double whole = r.J[a] * r.J[b];
                noise(a, b) = whole - shares[directions] * (whole - kept[directions] * noise(a, b));
            }
        all.push_back(noise);
    }
    return all;
}

}  // namespace cv::iib
