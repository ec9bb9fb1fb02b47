// SPDX-License-Identifier: Apache-2.0

#include "../precomp.hpp"

#include <algorithm>
#include <map>

#include "opencv2/imgproc.hpp"
#include "camera_pose.hpp"
#include "two_views.hpp"

namespace cv::iib {
namespace {

constexpr int ROUNDS = 20;
constexpr int CLUSTERS = 4;  // across and down the area that the matches span in the image
// Smallest over largest eigenvalue of the curvature: below, the pose is not determined.
constexpr double LEAST_CURVATURE = 1e-12;

}  // namespace

// The lens projects R (X - c). A rotation w about the world's axes changes R to R (1 - [w]x). So this vector changes by
// -R dc with the centre, and by R [X - c]x dw with the rotation.
std::vector<LinearMatch> linearize(const std::vector<Match>& matches, const Lens& lens, const Affine3d& pose)
{
    std::vector<Matx23d> byPoint;
    const std::vector<Point2d> mapped = lens.project(inCamera(matches, pose), &byPoint);
    const Matx33d rotation = pose.rotation();
    const Vec3d centre = inverse(pose).translation();
    std::vector<LinearMatch> found(matches.size());
    for (size_t i = 0; i < matches.size(); i++)
    {
        const Point2d error = matches[i].errorProjection * (matches[i].pixel - mapped[i]);
        const double weight = 1 / (matches[i].deviation * matches[i].deviation + error.dot(error));
        if (std::isnan(weight))
            continue;
        // derivatives by the point, in the world's axes
        const Matx23d byMoved = matches[i].errorProjection * byPoint[i] * rotation;
        setBlock(found[i].byPose, 0, 0, -byMoved);
        setBlock(found[i].byPose, 0, 3, byMoved * crossProduct(Vec3d(matches[i].point) - centre));
        found[i].error = {error.x, error.y};
        found[i].weight = weight;
    }
    return found;
}

Affine3d moved(const Affine3d& pose, const Vec6d& step)
{
    const Vec3d centre = inverse(pose).translation() + Vec3d(step.val);
    const Matx33d rotation = pose.rotation() * Affine3d(-Vec3d(step.val + 3)).rotation();
    return {rotation, -(rotation * centre)};
}

double distance(const Affine3d& a, const Affine3d& b, double depth)
{
    const Affine3d turn = a * inverse(b);
    const double way = norm(inverse(a).translation() - inverse(b).translation());
    return way / depth + std::acos(std::clamp(turn.rotation()(2, 2), -1., 1.));
}

Frame::Frame(const std::vector<Match>& matches)
{
    std::vector<double> axes[3], distances;
    for (const Match& m : matches)
        for (int i = 0; i < 3; i++)
            axes[i].push_back(Vec3d(m.point)[i]);
    centre = {median(axes[0]), median(axes[1]), median(axes[2])};
    for (const Match& m : matches)
        distances.push_back(norm(Vec3d(m.point) - centre));
    const double typical = median(distances);
    unit = typical > 0 ? typical : 1;
}

Point3d Frame::toLocal(const Point3d& point) const { return (Vec3d(point) - centre) * (1 / unit); }

Affine3d Frame::toLocal(const Affine3d& cameraFromWorld) const
{
    const Matx33d rotation = cameraFromWorld.rotation();
    return {rotation, (cameraFromWorld.translation() + rotation * centre) * (1 / unit)};
}

Affine3d Frame::toWorld(const Affine3d& cameraFromLocal) const
{
    const Matx33d rotation = cameraFromLocal.rotation();
    return {rotation, cameraFromLocal.translation() * unit - rotation * centre};
}

Matx66d Frame::toWorld(const Matx66d& covariance) const
{
    const Matx66d scale = Matx66d::diag({unit, unit, unit, 1, 1, 1});
    return scale * covariance * scale;
}

std::vector<Point3d> inCamera(const std::vector<Point3d>& points, const Affine3d& pose)
{
    std::vector<Point3d> moved;
    for (const Point3d& p : points)
        moved.push_back(pose * p);
    return moved;
}

std::vector<Point3d> inCamera(const std::vector<Match>& matches, const Affine3d& pose)
{
    std::vector<Point3d> moved;
    for (const Match& m : matches)
        moved.push_back(pose * m.point);
    return moved;
}

std::vector<double> errorsOf(const std::vector<Match>& matches, const Lens& lens, const Affine3d& pose)
{
    const std::vector<Point2d> mapped = lens.project(inCamera(matches, pose));
    std::vector<double> errors;
    for (size_t i = 0; i < matches.size(); i++)
        errors.push_back(norm(matches[i].errorProjection * (mapped[i] - matches[i].pixel)));
    return errors;
}

std::vector<Match> within(
        double limit, const std::vector<Match>& matches, const Lens& lens, const Affine3d& pose)
{
    const std::vector<double> errors = errorsOf(matches, lens, pose);
    std::vector<Match> inliers;
    for (size_t i = 0; i < matches.size(); i++)
        if (errors[i] < limit)  // not NaN, behind the camera
            inliers.push_back(matches[i]);
    return inliers;
}

double medianDistance(const std::vector<Point3d>& points)
{
    std::vector<double> distances;
    for (const Point3d& p : points)
        distances.push_back(norm(p));
    return median(distances);
}

double deviationOf(const std::vector<double>& errors) { return median(errors) / 1.1774; }

bool poseByRansac(const std::vector<Match>& matches, const Lens& lens, double limit, Affine3d& pose)
{
    std::vector<Point2d> pixels;
    std::vector<Point3d> points;
    for (const Match& m : matches)
        if (const Point2d straight = lens.undistorted({m.pixel})[0]; std::isfinite(straight.x))
        {
            pixels.push_back(straight);
            points.push_back(m.point);
        }
    if (points.size() < 4)
        return false;
    UsacParams parameters;
    parameters.score = SCORE_METHOD_MAGSAC;
    parameters.threshold = limit;
    parameters.confidence = .999;
    parameters.maxIterations = 10000;
    Mat matrix(lens.matrix()), rotation, translation, inliers;
    if (!solvePnPRansac(points, pixels, matrix, noArray(), rotation, translation, inliers, parameters))
        return false;
    pose = {Vec3d(rotation.ptr<double>()), Vec3d(translation.ptr<double>())};
    return checkRange(Mat(pose.matrix));
}

bool refinePose(const std::vector<Match>& matches, const Lens& lens, Affine3d& pose, Matx66d& covariance)
{
    for (int round = 0; round < ROUNDS; round++)
    {
        Matx66d normal = Matx66d::zeros();
        Vec6d gradient;
        for (const LinearMatch& m : linearize(matches, lens, pose))
        {
            normal += m.weight * m.byPose.t() * m.byPose;
            gradient += m.weight * (m.byPose.t() * m.error);
        }
        Vec6d step;
        if (!solve(normal, gradient, step, DECOMP_CHOLESKY) || !checkRange(step))
            return false;
        pose = moved(pose, step);
        bool regular = false;
        covariance = normal.inv(DECOMP_CHOLESKY, &regular);
        if (!regular)
            return false;
        if (norm(Vec3d(step.val + 3)) < 1e-8)
            break;
    }
    return true;
}

bool clusteredCovariance(
        const std::vector<Match>& matches, const Lens& lens, const Affine3d& pose, Matx66d& covariance)
{
    const std::vector<LinearMatch> near = linearize(matches, lens, pose);
    std::vector<Point2f> pixels;
    for (const Match& m : matches)
        pixels.push_back(m.pixel);
    const Rect2d span = boundingRect(pixels);
    std::map<std::pair<int, int>, Vec6d> gradients;  // by cluster
    std::vector<double> errors;
    Matx66d curvature = Matx66d::zeros(), ofGradient = Matx66d::zeros();
    for (size_t i = 0; i < near.size(); i++)
    {
        const LinearMatch& m = near[i];
        const double deviation = matches[i].deviation;
        errors.push_back(norm(m.error) / deviation);
        curvature += m.weight * m.weight * deviation * deviation * m.byPose.t() * m.byPose;
        gradients[{int(CLUSTERS * (pixels[i].x - span.x) / span.width),
                int(CLUSTERS * (pixels[i].y - span.y) / span.height)}] += m.weight * (m.byPose.t() * m.error);
    }
    for (const auto& cluster : gradients)
        ofGradient += cluster.second * cluster.second.t();
    Vec6d eigenvalues;
    if (!eigen(curvature, eigenvalues) || !(eigenvalues[5] > LEAST_CURVATURE * eigenvalues[0]))
        return false;
    const double scale = deviationOf(errors), clusters = double(gradients.size());
    const Matx66d back = curvature.inv(DECOMP_CHOLESKY);
    covariance =
            scale * scale * covariance + clusters / std::max(clusters - 6, 1.) * back * ofGradient * back;
    return true;
}

}  // namespace cv::iib
