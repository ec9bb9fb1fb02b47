// SPDX-License-Identifier: Apache-2.0

#include "triangulation.hpp"

#include <algorithm>
#include <map>
#include <numeric>

#include "../common/parallel.hpp"

namespace cv::iib {
namespace {

constexpr double MAX_ERROR = 4;    // pixels between a keypoint and its projected point
constexpr double MIN_ANGLE = 1.5;  // degrees between the rays of a point
constexpr int ROUNDS = 5;          // of a point's refinement

double angleOf(const Ray& a, const Ray& b)
{
    return std::atan2(norm(a.direction.cross(b.direction)), a.direction.dot(b.direction));
}

/** The point x with the least Cauchy loss (one pixel) of its angles to the rays: the sum of w (1 - d d') (x - c) is 0,
with the centre c and direction d of each ray (the midpoint method of Hartley and Sturm 1997, reweighted). */
Vec3d nearestPoint(const Track& track)
{
    const Vec3d origin = track[0].centre;  // keeps precision far from the world's origin
    Vec3d point;
    std::vector<double> weights(track.size(), 1);
    for (int round = 0; round < ROUNDS; round++)
    {
        Matx33d normal = Matx33d::zeros();
        Vec3d sum;
        for (size_t i = 0; i < track.size(); i++)
        {
            const Vec3d& along = track[i].direction;
            const Matx33d across = weights[i] / weights[0] * (Matx33d::eye() - along * along.t());
            normal += across;
            sum += across * (track[i].centre - origin);
        }
        point = origin + normal.solve(sum, DECOMP_LU);
        for (size_t i = 0; i < track.size(); i++)
        {
            const Vec3d way = point - track[i].centre;
            const double error = track[i].error(point);
            weights[i] = 1 / (way.dot(way) * (1 + error * error));
        }
    }
    return point;
}

}  // namespace

std::vector<Track> tracksOf(const std::vector<Ray>& rays, std::vector<RayMatch> links)
{
    std::stable_sort(
            links.begin(), links.end(), [](const RayMatch& a, const RayMatch& b) { return a.bits < b.bits; });
    std::vector<size_t> trackOf(rays.size());
    std::iota(trackOf.begin(), trackOf.end(), size_t(0));
    std::vector<std::vector<size_t>> tracks;
    for (size_t k : trackOf)
        tracks.push_back({k});
    const auto join = [&](size_t a, size_t b) {
        std::vector<size_t>&into = tracks[trackOf[a]], &from = tracks[trackOf[b]];
        const auto clashes = [&](size_t k) {
            return std::any_of(into.begin(), into.end(), [&](size_t o) {
                return rays[o].image == rays[k].image ||
                       (rays[o].point >= 0 && rays[k].point >= 0 && rays[o].point != rays[k].point);
            });
        };
        if (std::any_of(from.begin(), from.end(), clashes))  // also if both are one track already
            return;
        for (size_t k : from)
            trackOf[k] = trackOf[a];
        into.insert(into.end(), from.begin(), from.end());
        from.clear();
    };
    std::map<int, size_t> known;  // first ray of each point
    for (size_t k = 0; k < rays.size(); k++)
        if (rays[k].point >= 0)
            join(known.emplace(rays[k].point, k).first->second, k);
    for (const RayMatch& link : links)
        join(link.a, link.b);
    std::vector<Track> found;
    for (const std::vector<size_t>& track : tracks)
        if (track.size() > 1)
        {
            found.emplace_back();
            for (size_t k : track)
                found.back().push_back(rays[k]);
        }
    return found;
}

namespace {

/** Refines the keypoints of each track against a reference: one that sees a point already, else the ray with the
smallest angles to the others. Keypoints that see a point stay. */
void refineTracks(std::vector<Track>& tracks, std::vector<MapImage>& images)
{
    std::map<std::pair<size_t, size_t>, std::vector<std::pair<int, int>>> jobs;  // keypoints by images
    for (Track& track : tracks)
    {
        const auto angleToOthers = [&](const Ray& ray) {
            double sum = 0;
            for (const Ray& other : track)
                sum += angleOf(ray, other);
            return ray.point >= 0 ? -1 : sum;
        };
        const Ray& reference = *std::min_element(track.begin(), track.end(),
                [&](const Ray& a, const Ray& b) { return angleToOthers(a) < angleToOthers(b); });
        for (const Ray& ray : track)
            if (ray.point < 0 && ray.image != reference.image)
                jobs[{reference.image, ray.image}].emplace_back(reference.keypoint, ray.keypoint);
    }
    std::vector<const decltype(jobs)::value_type*> list;
    std::vector<std::atomic<int>> uses(images.size());
    for (const auto& job : jobs)
    {
        list.push_back(&job);
        for (size_t i : {job.first.first, job.first.second})
            uses[i]++;
    }
    PreparedPictures prepared(images.size());
    inParallel(list.size(), [&](size_t n) {
        const auto& [numbers, keypoints] = *list[n];
        const MapImage& fixed = images[numbers.first];
        MapImage& moved = images[numbers.second];
        if (!fixed.picture.pixels.empty() && !moved.picture.pixels.empty())
        {
            KeypointPairs pairs;
            for (const auto& [a, b] : keypoints)
            {
                pairs.fixed.emplace_back(fixed.pixels[size_t(a)], fixed.sizes[size_t(a)]);
                pairs.moved.emplace_back(moved.pixels[size_t(b)], moved.sizes[size_t(b)]);
            }
            refine(prepared.of(numbers.first, fixed.picture), prepared.of(numbers.second, moved.picture),
                    pairs);
            // no other job writes these: a keypoint has one track
            for (size_t i = 0; i < keypoints.size(); i++)
                moved.pixels[size_t(keypoints[i].second)] = pairs.moved[i].pt;
        }
        for (size_t i : {numbers.first, numbers.second})
            if (--uses[i] == 0)
                prepared.release(i);
    });
    std::vector<std::vector<Ray*>> rays(images.size());
    for (Track& track : tracks)
        for (Ray& ray : track)
            rays[ray.image].push_back(&ray);
    for (size_t i = 0; i < images.size(); i++)
    {
        const std::vector<Ray> own = rays[i].empty() ? Track() : raysOf(i, images[i]);
        for (Ray* ray : rays[i])
            ray->direction = own[size_t(ray->keypoint)].direction;
    }
}

}  // namespace

bool triangulatePoint(Track& track, Point3d& point)
{
    for (; track.size() > 1;)
    {
        point = nearestPoint(track);
        const auto worst = std::max_element(track.begin(), track.end(),
                [&](const Ray& a, const Ray& b) { return a.error(point) < b.error(point); });
        if (worst->error(point) < MAX_ERROR)
            break;
        track.erase(worst);
    }
    double widest = 0;
    for (const Ray& a : track)
        for (const Ray& b : track)
            widest = std::max(widest, angleOf(a, b));
    return widest * 180 / CV_PI >= MIN_ANGLE;
}

void triangulate(Map& map, std::vector<Ray> rays, std::vector<RayMatch> links)
{
    std::vector<Track> tracks = tracksOf(rays, std::move(links));
    rays = {};  // before more memory is needed
    refineTracks(tracks, map.images);
    for (Track& track : tracks)
    {
        const auto known =
                std::find_if(track.begin(), track.end(), [](const Ray& r) { return r.point >= 0; });
        const size_t number = known == track.end() ? map.points.size() : size_t(known->point);
        if (std::all_of(track.begin(), track.end(), [](const Ray& r) { return r.point >= 0; }))
            continue;  // no new keypoint
        for (const Ray& ray : track)
            map.images[ray.image].sees[size_t(ray.keypoint)] = -1;
        Point3d point;
        if (!triangulatePoint(track, point))
            continue;
        map.points.resize(std::max(map.points.size(), number + 1));
        map.points[number] = point;
        for (const Ray& ray : track)
            map.images[ray.image].sees[size_t(ray.keypoint)] = int(number);
    }
}

}  // namespace cv::iib
