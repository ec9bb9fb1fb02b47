// SPDX-License-Identifier: Apache-2.0

#include "lines.hpp"

#include <algorithm>
#include <functional>
#include <numeric>
#include <set>

#include "../common/parallel.hpp"
#include "triangulation.hpp"

namespace cv::iib {
namespace {

constexpr double DEVIATION = .7;         // pixels: standard deviation of two segments' ends together
constexpr double MAX_UNCERTAINTY = .05;  // of a line's ends, as a share of their distance
constexpr double MAX_ERROR = 3;          // pixels between a line and a segment of its track
constexpr double MAX_ANGLE = 5;          // degrees between a segment and a projected line
constexpr double MIN_OVERLAP = 1. / 3;   // of the shorter of segment and line
constexpr double NEAR_PLANE = .05;       // share of the farther end's depth at which lines are clipped
constexpr int MAP_BITS = 60;             // most differing bits between codes of a line in the map's images
constexpr int QUERY_BITS = 80;           // the same under changed illumination

/** Triangulates a track. The ends of its longest segment get the depth n (c' - c) / (n d) along their rays: least
squares over the planes through the other segments, with normals n and camera centres c'.
@param rays in pairs: to the beginning of each segment, as in the track, then to its end.
@param first index of each image's first ray.
@return false if an end is behind its camera, or DEVIATION would move it by more than this share of its distance. */
bool placeLine(const Track& track, const std::vector<Ray>& rays, const std::vector<size_t>& first,
        MapLine& line, double maxUncertainty)
{
    const auto ends = [&](const Ray& r) { return &rays[first[r.image] + size_t(r.keypoint)]; };
    const auto normal = [&](const Ray& r) { return ends(r)[0].direction.cross(ends(r)[1].direction); };
    const Ray& longest = *std::max_element(track.begin(), track.end(),
            [&](const Ray& a, const Ray& b) { return norm(normal(a)) < norm(normal(b)); });
    for (int i : {0, 1})
    {
        const Ray& ray = ends(longest)[i];
        double squares = 0, sum = 0;
        for (const Ray& other : track)
            if (&other != &longest)
            {
                const Vec3d plane = normalize(normal(other));
                squares += plane.dot(ray.direction) * plane.dot(ray.direction);
                sum += plane.dot(ray.direction) * plane.dot(other.centre - ray.centre);
            }
        const double depth = sum / squares;
        if (!(depth > 0 && DEVIATION < maxUncertainty * ray.scale * std::sqrt(squares)))
            return false;
        (i == 0 ? line.begin : line.end) = ray.centre + depth * ray.direction;
    }
    return true;
}

/** Matches lines with segments greedily, fewest differing bits first; each line and each segment is used once.
@param lines of each code; a line may have several codes. */
std::vector<DMatch> greedyMatches(const std::vector<int>& lines, const Mat& codes, const Mat& segments,
        int maxBits, const std::function<bool(int, int)>& fit)
{
    std::vector<DMatch> all, found;
    Mat_<int> bits;
    if (!codes.empty() && !segments.empty())
        batchDistance(codes, segments, bits, CV_32S, noArray(), NORM_HAMMING);
    for (int row = 0; row < bits.rows; row++)
        for (int s = 0; s < bits.cols; s++)
            if (bits(row, s) <= maxBits && fit(row, s))
                all.emplace_back(row, s, float(bits(row, s)));
    std::stable_sort(all.begin(), all.end());
    std::set<int> taken, takenSegments;
    for (const DMatch& m : all)
        if (takenSegments.count(m.trainIdx) == 0 && taken.insert(lines[size_t(m.queryIdx)]).second)
        {
            takenSegments.insert(m.trainIdx);
            found.push_back(m);
        }
    return found;
}

}  // namespace

void addLines(Map& map, const std::vector<Segments>& segments, const Pairs& pairs)
{
    std::vector<Ray> rays;
    std::vector<size_t> first;
    std::vector<Lens> lenses;
    for (size_t i = 0; i < map.images.size(); i++)
    {
        PosedImage image = {"", map.images[i].camera, map.images[i].cameraFromWorld, {}, {}};
        for (const Segment& s : segments[i].places)
            image.pixels.insert(image.pixels.end(), {s.begin, s.end});
        lenses.emplace_back(image.camera);
        first.push_back(rays.size());
        const std::vector<Ray> own = raysOf(i, image);
        rays.insert(rays.end(), own.begin(), own.end());
    }
    const auto sees = [&](const Ray& ray, const MapLine& line) {
        return !matchesOf(line, segments[ray.image].places[size_t(ray.keypoint) / 2], lenses[ray.image],
                map.images[ray.image].cameraFromWorld, MAX_ERROR)
                        .empty();
    };
    std::vector<std::vector<RayMatch>> found(pairs.size());
    inParallel(pairs.size(), [&](size_t n) {
        const auto [a, b] = pairs[n];
        std::vector<int> numbers(segments[a].places.size());
        std::iota(numbers.begin(), numbers.end(), 0);
        const auto link = [&, one = first[a], other = first[b]](int s, int t, float bits) {
            return RayMatch{bits, uint32_t(one + 2 * size_t(s)), uint32_t(other + 2 * size_t(t))};
        };
        const auto fit = [&](int s, int t) {
            const Ray &one = rays[link(s, t, 0).a], &other = rays[link(s, t, 0).b];
            MapLine line;
            return placeLine({one, other}, rays, first, line, HUGE_VAL) && sees(one, line) &&
                   sees(other, line);
        };
        for (const DMatch& m : greedyMatches(numbers, segments[a].codes, segments[b].codes, MAP_BITS, fit))
            found[n].push_back(link(m.queryIdx, m.trainIdx, m.distance));
    });
    std::vector<RayMatch> links;
    for (const std::vector<RayMatch>& some : found)
        links.insert(links.end(), some.begin(), some.end());
    for (Track& track : tracksOf(rays, std::move(links)))
    {
        MapLine line;
        for (size_t before = 0; before != track.size() && track.size() > 1;)
        {
            before = track.size();
            if (!placeLine(track, rays, first, line, MAX_UNCERTAINTY))
                track.clear();
            track.erase(std::remove_if(
                                track.begin(), track.end(), [&](const Ray& ray) { return !sees(ray, line); }),
                    track.end());
        }
        if (track.size() < 2)
            continue;
        for (const Ray& ray : track)
        {
            map.images[ray.image].lines.push_back(int(map.lines.size()));
            map.images[ray.image].lineCodes.push_back(segments[ray.image].codes.row(ray.keypoint / 2));
        }
        map.lines.push_back(line);
    }
}

std::vector<Match> matchesOf(
        const MapLine& line, const Segment& segment, const Lens& lens, const Affine3d& pose, double limit)
{
    Point3d ends[] = {pose * line.begin, pose * line.end};
    const double nearest = NEAR_PLANE * std::max(ends[0].z, ends[1].z);
    for (int i : {0, 1})  // clips what is behind the camera
        if (ends[i].z < nearest && nearest > 0)
            ends[i] += (ends[1 - i] - ends[i]) * ((nearest - ends[i].z) / (ends[1 - i].z - ends[i].z));
    const std::vector<Point2d> pixels = lens.project({ends[0], ends[1]});
    const double length = norm(segment.end - segment.begin);
    const Point2d along = (segment.end - segment.begin) / length, across(-along.y, along.x);
    // Positions along the segment from its beginning, in pixels.
    const double from = along.dot(pixels[0] - segment.begin), to = along.dot(pixels[1] - segment.begin);
    const double begin = std::max(from, 0.), end = std::min(to, length);
    if (!(to - from > std::cos(MAX_ANGLE * CV_PI / 180) * norm(pixels[1] - pixels[0])) ||
            end - begin < MIN_OVERLAP * std::min(length, to - from))
        return {};
    std::vector<Match> matches;
    for (double place : {begin, end})
    {
        const double share = (place - from) / (to - from);  // in the image
        const double part = share * ends[0].z / (ends[1].z + share * (ends[0].z - ends[1].z));
        const Point3d point = ends[0] + (ends[1] - ends[0]) * part;
        matches.push_back({segment.begin + along * place, inverse(pose) * point});
        matches.back().errorProjection =
                Matx22d(across.x * across.x, across.x * across.y, across.x * across.y, across.y * across.y);
        if (!(std::abs(across.dot(lens.project({point})[0] - matches.back().pixel)) < limit))
            return {};
    }
    return matches;
}

std::vector<Match> lineMatches(const Map& map, const std::vector<size_t>& images, const Segments& segments,
        const Lens& lens, const Frame& frame, const Affine3d& pose, double limit)
{
    std::vector<int> lines;
    Mat codes;
    for (size_t i : images)
    {
        lines.insert(lines.end(), map.images[i].lines.begin(), map.images[i].lines.end());
        codes.push_back(map.images[i].lineCodes);
    }
    const auto ends = [&](int row, int segment) {
        const MapLine& line = map.lines[size_t(lines[size_t(row)])];
        return matchesOf({frame.toLocal(line.begin), frame.toLocal(line.end)},
                segments.places[size_t(segment)], lens, pose, limit);
    };
    const auto fit = [&](int row, int segment) { return !ends(row, segment).empty(); };
    std::vector<Match> matches;
    for (const DMatch& m : greedyMatches(lines, codes, segments.codes, QUERY_BITS, fit))
        for (const Match& end : ends(m.queryIdx, m.trainIdx))
            matches.push_back(end);
    return matches;
}

}  // namespace cv::iib
