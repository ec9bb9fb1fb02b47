// SPDX-License-Identifier: Apache-2.0

#include <optional>

#include "../common/parallel.hpp"
#include "../pose/camera_pose.hpp"
#include "../pose/two_views.hpp"
#include "triangulation.hpp"

namespace cv::iib {
namespace {

constexpr size_t MAX_IMAGES = 32, MAX_KEYPOINTS = 500;  // of a map, of each of these images
constexpr double MAX_ERROR = 4;                         // pixels between a keypoint and its projected point
constexpr double LEAST_DEVIATION = .03;                 // pixels
constexpr size_t LEAST_POINTS = 15;
constexpr int ROUNDS = 3;  // of refining a pose, each with the deviation that the last one left

typedef std::vector<std::vector<Ray>> RaysOfPoints;

//! An even sample of the model's own images; images of updates were themselves located in the map.
std::vector<size_t> sampleOf(const std::vector<MapImage>& images)
{
    std::vector<size_t> own, sample;
    for (size_t i = 0; i < images.size(); i++)
        if (!images[i].added)
            own.push_back(i);
    const size_t count = std::min(own.size(), MAX_IMAGES);
    for (size_t n = 0; n < count; n++)
        sample.push_back(own[n * own.size() / count]);
    return sample;
}

//! Keypoints of the sampled images whose points at least two other images see.
std::vector<std::vector<size_t>> seenByOthers(const Map& map, const std::vector<size_t>& sample)
{
    std::vector<int> views(map.points.size());
    for (const MapImage& image : map.images)
        for (int point : image.sees)
            views[size_t(point)]++;
    std::vector<std::vector<size_t>> rows(sample.size());
    for (size_t n = 0; n < sample.size(); n++)
    {
        const std::vector<int>& sees = map.images[sample[n]].sees;
        for (size_t row = 0; row < sees.size() && rows[n].size() < MAX_KEYPOINTS; row++)
            if (views[size_t(sees[row])] > 2)
                rows[n].push_back(row);
    }
    return rows;
}

RaysOfPoints raysOfPoints(
        const Map& map, const std::vector<size_t>& sample, const std::vector<std::vector<size_t>>& rows)
{
    std::vector<bool> wanted(map.points.size());
    for (size_t n = 0; n < sample.size(); n++)
        for (size_t row : rows[n])
            wanted[size_t(map.images[sample[n]].sees[row])] = true;
    RaysOfPoints rays(map.points.size());
    for (size_t i = 0; i < map.images.size(); i++)
    {
        const MapImage& image = map.images[i];
        PosedImage part = {image.name, image.camera, image.cameraFromWorld, {}, {}};
        for (size_t row = 0; row < image.sees.size(); row++)
            if (wanted[size_t(image.sees[row])])
            {
                part.pixels.push_back(image.pixels[row]);
                part.sees.push_back(image.sees[row]);
            }
        for (const Ray& ray : raysOf(i, part))
            rays[size_t(ray.point)].push_back(ray);
    }
    return rays;
}

//! Keypoints of an image with points that the other images triangulate.
std::vector<Match> triangulatedByOthers(
        const MapImage& image, size_t number, const std::vector<size_t>& rows, const RaysOfPoints& rays)
{
    std::vector<Match> matches;
    for (size_t row : rows)
    {
        Track others;
        for (const Ray& ray : rays[size_t(image.sees[row])])
            if (ray.image != number)
                others.push_back(ray);
        Match match{image.pixels[row], {}};
        if (others.size() > 1 && triangulatePoint(others, match.point))
            matches.push_back(match);
    }
    return matches;
}

/** The deviation of an image's pose from that in the map, in the units of mapError(); none if too few points remain.
@param matches of its keypoints with points that it did not triangulate. */
std::optional<Vec6d> poseErrorOf(const MapImage& image, std::vector<Match> matches)
{
    const Frame frame(matches);
    for (Match& m : matches)
        m.point = frame.toLocal(m.point);
    const Lens lens(image.camera);
    const Affine3d known = frame.toLocal(image.cameraFromWorld);
    Affine3d pose = known;
    for (int round = 0; round < ROUNDS; round++)
    {
        matches = within(MAX_ERROR, matches, lens, pose);
        const double deviation = std::max(LEAST_DEVIATION, deviationOf(errorsOf(matches, lens, pose)));
        for (Match& m : matches)
            m.deviation = deviation;
        Matx66d covariance;
        if (matches.size() < LEAST_POINTS || !refinePose(matches, lens, pose, covariance))
            return std::nullopt;
    }
    const double depth = medianDistance(inCamera(matches, pose));
    const Vec3d moved = known * inverse(pose).translation() * (1 / depth),
                turned = Affine3d(known.rotation() * pose.rotation().t()).rvec();
    return Vec6d(moved[0], moved[1], moved[2], turned[0], turned[1], turned[2]);
}

//! The covariance averaged over all directions, separately for centre and rotation.
Matx66d isotropic(const Matx66d& covariance)
{
    Matx66d same = Matx66d::zeros();
    for (int k = 0; k < 6; k++)
        for (int axis = 0; axis < 3; axis++)
            same(k, k) += covariance(k / 3 * 3 + axis, k / 3 * 3 + axis) / 3;
    return same;
}

}  // namespace

Matx66d mapError(const Map& map)
{
    const std::vector<size_t> sample = sampleOf(map.images);
    const std::vector<std::vector<size_t>> rows = seenByOthers(map, sample);
    const RaysOfPoints rays = raysOfPoints(map, sample, rows);
    std::vector<std::optional<Vec6d>> errors(sample.size());
    inParallel(sample.size(), [&](size_t n) {
        const MapImage& image = map.images[sample[n]];
        errors[n] = poseErrorOf(image, triangulatedByOthers(image, sample[n], rows[n], rays));
    });
    Matx66d sum = Matx66d::zeros();
    int count = 0;
    for (const std::optional<Vec6d>& error : errors)
        if (error)
        {
            sum += *error * error->t();
            count++;
        }
    count = std::max(count, 1);
    return (sum + isotropic(sum) * (1. / count)) * (1. / count);
}

Matx66d inWorld(const Matx66d& error, const Affine3d& cameraFromWorld, double depth)
{
    const Matx33d toWorld = cameraFromWorld.rotation().t();
    Matx66d axes;
    setBlock(axes, 0, 0, toWorld * depth);
    setBlock(axes, 3, 3, toWorld);
    return axes * error * axes.t();
}

}  // namespace cv::iib
