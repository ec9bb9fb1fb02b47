// SPDX-License-Identifier: Apache-2.0

#include "map_error.hpp"

#include <algorithm>
#include <optional>

#include "../common/parallel.hpp"
#include "../pose/camera_pose.hpp"
#include "triangulation.hpp"

namespace cv::iib {
namespace {

constexpr size_t IMAGES = 32, KEYPOINTS = 500;  // at most: of a map, evenly, and the strongest of each
constexpr double MAX_ERROR = 4;                 // pixels, of a keypoint from its point
constexpr double LEAST_DEVIATION = .03;         // pixels
constexpr size_t LEAST_POINTS = 15;
constexpr int ROUNDS = 3;  // of a pose, each with the deviation that the last one left

//! The rays that see each point of a map.
typedef std::vector<std::vector<Ray>> Sights;

//! Of the model's own images, since those of updates were located in the map.
std::vector<size_t> someOf(const std::vector<MapImage>& images)
{
    std::vector<size_t> own, some;
    for (size_t i = 0; i < images.size(); i++)
        if (!images[i].added)
            own.push_back(i);
    const size_t count = std::min(own.size(), IMAGES);
    for (size_t n = 0; n < count; n++)
        some.push_back(own[n * own.size() / count]);
    return some;
}

//! Keypoints of some images whose points two others see or more.
std::vector<std::vector<size_t>> seenByOthers(const Map& map, const std::vector<size_t>& some)
{
    std::vector<int> views(map.points.size());
    for (const MapImage& image : map.images)
        for (int point : image.sees)
            views[size_t(point)]++;
    std::vector<std::vector<size_t>> rows(some.size());
    for (size_t n = 0; n < some.size(); n++)
    {
        const std::vector<int>& sees = map.images[some[n]].sees;
        for (size_t row = 0; row < sees.size() && rows[n].size() < KEYPOINTS; row++)
            if (views[size_t(sees[row])] > 2)
                rows[n].push_back(row);
    }
    return rows;
}

Sights sightsOf(const Map& map, const std::vector<size_t>& some, const std::vector<std::vector<size_t>>& rows)
{
    std::vector<bool> wanted(map.points.size());
    for (size_t n = 0; n < some.size(); n++)
        for (size_t row : rows[n])
            wanted[size_t(map.images[some[n]].sees[row])] = true;
    Sights sights(map.points.size());
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
            sights[size_t(ray.point)].push_back(ray);
    }
    return sights;
}

//! Keypoints of an image with the points that the others place.
std::vector<Match> placedByOthers(
        const MapImage& image, size_t number, const std::vector<size_t>& rows, const Sights& sights)
{
    std::vector<Match> matches;
    for (size_t row : rows)
    {
        Track others;
        for (const Ray& ray : sights[size_t(image.sees[row])])
            if (ray.image != number)
                others.push_back(ray);
        Match match{image.pixels[row], {}};
        if (others.size() > 1 && place(others, match.point))
            matches.push_back(match);
    }
    return matches;
}

/** How far from where the map has it an image comes to lie, as mapError() tells it; nothing if too few points tell.
@param matches of its keypoints with points that it did not place. */
std::optional<Vec6d> strayOf(const MapImage& image, std::vector<Match> matches)
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
    const double depth = medianDistance(inCamera(pointsOf(matches), pose));
    const Vec3d moved = known * inverse(pose).translation() * (1 / depth),
                turned = Affine3d(known.rotation() * pose.rotation().t()).rvec();
    return Vec6d(moved[0], moved[1], moved[2], turned[0], turned[1], turned[2]);
}

//! As large a covariance of the centre, and of the turn, that is the same in all directions.
Matx66d withoutDirection(const Matx66d& covariance)
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
    const std::vector<size_t> some = someOf(map.images);
    const std::vector<std::vector<size_t>> rows = seenByOthers(map, some);
    const Sights sights = sightsOf(map, some, rows);
    std::vector<std::optional<Vec6d>> strays(some.size());
    inParallel(some.size(), [&](size_t n) {
        const MapImage& image = map.images[some[n]];
        strays[n] = strayOf(image, placedByOthers(image, some[n], rows[n], sights));
    });
    Matx66d sum = Matx66d::zeros();
    int count = 0;
    for (const std::optional<Vec6d>& stray : strays)
        if (stray)
        {
            sum += *stray * stray->t();
            count++;
        }
    count = std::max(count, 1);
    return (sum + withoutDirection(sum) * (1. / count)) * (1. / count);
}

Matx66d inWorld(const Matx66d& error, const Affine3d& cameraFromWorld, double depth)
{
    const Matx33d toWorld = cameraFromWorld.rotation().t();
    Matx66d axes = Matx66d::zeros();
    for (int y = 0; y < 3; y++)
        for (int x = 0; x < 3; x++)
        {
            axes(y, x) = toWorld(y, x) * depth;
            axes(y + 3, x + 3) = toWorld(y, x);
        }
    return axes * error * axes.t();
}

}  // namespace cv::iib
