// SPDX-License-Identifier: Apache-2.0

#include "lines.hpp"

#include <algorithm>
#include <limits>

#include "features.hpp"
#include "triangulation.hpp"

namespace iib_localization {
namespace {

constexpr double MIN_ANGLE = 2;          // degrees between the planes of a line
constexpr double DEVIATION = .5;         // pixels, of an end of a segment
constexpr double MAX_UNCERTAINTY = .05;  // of a line, see below
constexpr double MAX_ERROR = 3;          // pixels between a line and a segment that it was made of
constexpr int MAX_BITS = 60;             // in which the codes of one line differ

//! The plane in which a camera sees a segment, and the rays to its ends.
struct Plane
{
    cv::Vec3d centre, ends[2], normal;  //!< the normal as long as the sine of the angle between the ends
    double deviation;                   //!< of an end, in radians
};

std::vector<Plane> planesOf(const MapImage& image, const Segments& segments)
{
    cv::iib::PosedImage ends;
    ends.camera = image.camera;
    ends.cameraFromWorld = image.cameraFromWorld;
    for (const Segment& s : segments.places)
        ends.pixels.insert(ends.pixels.end(), {s.begin, s.end});
    const std::vector<Ray> rays = raysOf(0, ends);
    std::vector<Plane> planes;
    for (size_t i = 0; i < rays.size(); i += 2)
    {
        const cv::Vec3d &a = rays[i].direction, &b = rays[i + 1].direction;
        planes.push_back({rays[i].centre, {a, b}, a.cross(b), DEVIATION / rays[i].scale});
    }
    return planes;
}

/** The line in which planes cross, as long as it is seen in all together.
@return false if they are nearly parallel, see it in opposite directions or behind a camera, or no two see the same part. */
bool crossing(const std::vector<const Plane*>& planes, MapLine& line)
{
    cv::Matx33d normals = cv::Matx33d::zeros();
    for (const Plane* p : planes)
        normals += p->normal * p->normal.t();
    double widest = 0;
    for (const Plane* p : planes)
        for (const Plane* q : planes)
            widest = std::max(widest, cv::norm(cv::normalize(p->normal).cross(cv::normalize(q->normal))));
    cv::Vec3d values;
    cv::Matx33d vectors;
    if (!(widest > std::sin(MIN_ANGLE * CV_PI / 180)) || !cv::eigen(normals, values, vectors))
        return false;
    cv::Vec3d along(vectors.val + 6);
    if (along.dot(planes[0]->ends[1] - planes[0]->ends[0]) < 0)
        along *= -1;
    const cv::Vec3d origin = planes[0]->centre;
    cv::Vec3d sum;
    for (const Plane* p : planes)
        sum += p->normal * p->normal.dot(p->centre - origin);
    const cv::Vec3d foot = origin + (normals + values[0] * along * along.t()).solve(sum, cv::DECOMP_CHOLESKY);
    std::vector<double> begins, ends;
    for (const Plane* p : planes)
    {
        double places[2];
        for (int i = 0; i < 2; i++)  // where the ray to an end passes the line
        {
            const cv::Vec3d& ray = p->ends[i];
            const cv::Vec3d way = foot - p->centre;
            const double cosine = along.dot(ray);
            places[i] = (cosine * ray.dot(way) - along.dot(way)) / (1 - cosine * cosine);
            if (!(ray.dot(way + places[i] * along) > 0))
                return false;
        }
        if (!(places[1] > places[0]))
            return false;
        begins.push_back(places[0]);
        ends.push_back(places[1]);
    }
    double shortest = ends[0] - begins[0], overlap = 0;
    for (size_t i = 0; i < begins.size(); i++)
        for (size_t k = 0; k < i; k++)
        {
            shortest = std::min(ends[i] - begins[i], ends[k] - begins[k]);
            overlap = std::max(
                    overlap, (std::min(ends[i], ends[k]) - std::max(begins[i], begins[k])) / shortest);
        }
    line.begin = foot + *std::min_element(begins.begin(), begins.end()) * along;
    line.end = foot + *std::max_element(ends.begin(), ends.end()) * along;
    return overlap > .5;
}

/** How far the ends of a line move, in parts of their distance from the first camera, if each end of a segment is off by its
deviation: the root of the sum of squares. Infinite if there is no line then. */
double uncertainty(const std::vector<const Plane*>& planes, const MapLine& line)
{
    const cv::Point3d along = (line.end - line.begin) / cv::norm(line.end - line.begin),
                      from = planes[0]->centre;
    double sum = 0;
    for (size_t i = 0; i < planes.size(); i++)
        for (int end = 0; end < 2; end++)
        {
            Plane off = *planes[i];
            off.ends[end] += off.deviation * cv::normalize(off.normal);
            off.normal = off.ends[0].cross(off.ends[1]);
            std::vector<const Plane*> all = planes;
            all[i] = &off;
            MapLine moved;
            if (!crossing(all, moved))
                return std::numeric_limits<double>::infinity();
            double most = 0;
            for (const auto& [at, was] : {std::make_pair(moved.begin, line.begin), {moved.end, line.end}})
                most = std::max(most, cv::norm((at - was).cross(along)) / cv::norm(was - from));
            sum += most * most;
        }
    return std::sqrt(sum);
}

}  // namespace

void addLines(
        Map& map, const std::vector<Segments>& segments, const std::vector<std::pair<size_t, size_t>>& pairs)
{
    std::vector<std::vector<Plane>> planes;
    for (size_t i = 0; i < segments.size(); i++)
        planes.push_back(planesOf(map.images[i], segments[i]));
    std::vector<Ray> rays;  // only image and number count: those of one line are joined as those of one point
    std::vector<size_t> first;
    for (size_t i = 0; i < map.images.size(); i++)
    {
        first.push_back(rays.size());
        for (size_t s = 0; s < planes[i].size(); s++)
            rays.push_back({i, int(s), {}, {}, 1});
    }
    std::vector<std::vector<Link>> found(pairs.size());
    inParallel(pairs.size(), [&](size_t n) {
        const auto [a, b] = pairs[n];
        std::vector<Link> nearest(planes[b].size(), {float(MAX_BITS + 1), 0, 0});  // of each segment of b
        for (size_t s = 0; s < planes[a].size(); s++)
        {
            Link best{float(MAX_BITS + 1), first[a] + s, 0};
            for (size_t t = 0; t < planes[b].size(); t++)
            {
                MapLine line;
                const float bits = float(codeDistance(segments[a].codes, int(s), segments[b].codes, int(t)));
                if (bits < best.bits && crossing({&planes[a][s], &planes[b][t]}, line))
                    best = {bits, first[a] + s, first[b] + t};
            }
            if (best.bits <= MAX_BITS && best.bits < nearest[best.b - first[b]].bits)
                nearest[best.b - first[b]] = best;
        }
        for (const Link& link : nearest)
            if (link.bits <= MAX_BITS)
                found[n].push_back(link);
    });
    std::vector<Link> links;
    for (const std::vector<Link>& some : found)
        links.insert(links.end(), some.begin(), some.end());
    for (std::vector<Ray>& track : joined(rays, links))
        for (bool whole = false; !whole && track.size() > 1;)
        {
            std::vector<const Plane*> own;
            for (const Ray& ray : track)
                own.push_back(&planes[ray.image][size_t(ray.keypoint)]);
            MapLine line;
            if (!crossing(own, line) || uncertainty(own, line) > MAX_UNCERTAINTY)
                break;
            const auto away = std::remove_if(track.begin(), track.end(), [&](const Ray& ray) {
                const MapImage& image = map.images[ray.image];
                return SeenLine(line, Lens(image.camera), image.cameraFromWorld)
                        .matchesWith(segments[ray.image].places[size_t(ray.keypoint)], MAX_ERROR)
                        .empty();
            });
            whole = away == track.end();
            track.erase(away, track.end());
            for (const Ray& ray : track)
                if (whole)
                {
                    map.images[ray.image].lines.push_back(int(map.lines.size()));
                    map.images[ray.image].lineCodes.push_back(segments[ray.image].codes.row(ray.keypoint));
                }
            if (whole)
                map.lines.push_back(line);
        }
}

}  // namespace iib_localization
