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

constexpr double DEVIATION = .7;                 // pixels, of two segments' ends together
constexpr double MAX_UNCERTAINTY = .05;          // of a line's ends, in parts of their distance
constexpr double MAX_ERROR = 3;                  // pixels between a line and a segment that it was made of
constexpr double MAX_TURN = 5;                   // degrees between a segment and a line as it is seen
constexpr double MIN_SHARE = 1. / 3;             // of the shorter of both, that overlaps
constexpr double NEAREST = .05;                  // of the farther end's depth: where lines are cut off
constexpr int MAPPED_BITS = 60, SEEN_BITS = 80;  // in which codes of one line differ, in like and other light

/** The line that a track's longest segment shows, its ends where the planes through the others cut the rays to them: at the depth
n (c' - c) / (n d), by least squares over the planes' normals n and centres c'.
@param rays to the begin of each segment, which are the track's, and behind each to the end.
@param first of each image's.
@return false if it is behind a camera, or DEVIATION would move it by more than so many parts of its distance. */
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

/** Pairs of lines and segments that fit, of the fewest bits that differ first, each line and each segment once.
@param lines whose codes these are: some have several. */
std::vector<DMatch> nearest(const std::vector<int>& lines, const Mat& codes, const Mat& segments, int maxBits,
        const std::function<bool(int, int)>& fit)
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

void addLines(
        Map& map, const std::vector<Segments>& segments, const std::vector<std::pair<size_t, size_t>>& pairs)
{
    std::vector<Ray> rays;
    std::vector<size_t> first;
    std::vector<Lens> lenses;
    for (size_t i = 0; i < map.images.size(); i++)
    {
        PosedImage image;
        image.camera = map.images[i].camera;
        image.cameraFromWorld = map.images[i].cameraFromWorld;
        for (const Segment& s : segments[i].places)
            image.pixels.insert(image.pixels.end(), {s.begin, s.end});
        lenses.emplace_back(image.camera);
        first.push_back(rays.size());
        const std::vector<Ray> own = raysOf(i, image);
        rays.insert(rays.end(), own.begin(), own.end());
    }
    const auto shows = [&](const Ray& ray, const MapLine& line) {
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
            return RayMatch{bits, one + 2 * size_t(s), other + 2 * size_t(t)};
        };
        const auto fit = [&](int s, int t) {
            const Ray &one = rays[link(s, t, 0).a], &other = rays[link(s, t, 0).b];
            MapLine line;
            return placeLine({one, other}, rays, first, line, HUGE_VAL) && shows(one, line) &&
                   shows(other, line);
        };
        for (const DMatch& m : nearest(numbers, segments[a].codes, segments[b].codes, MAPPED_BITS, fit))
            found[n].push_back(link(m.queryIdx, m.trainIdx, m.distance));
    });
    std::vector<RayMatch> links;
    for (const std::vector<RayMatch>& some : found)
        links.insert(links.end(), some.begin(), some.end());
    for (Track& track : tracksOf(rays, links))
    {
        MapLine line;
        for (size_t before = 0; before != track.size() && track.size() > 1;)
        {
            before = track.size();
            if (!placeLine(track, rays, first, line, MAX_UNCERTAINTY))
                track.clear();
            track.erase(std::remove_if(track.begin(), track.end(),
                                [&](const Ray& ray) { return !shows(ray, line); }),
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
    const double nearest = NEAREST * std::max(ends[0].z, ends[1].z);
    for (int i : {0, 1})  // cuts off what is behind the camera
        if (ends[i].z < nearest && nearest > 0)
            ends[i] += (ends[1 - i] - ends[i]) * ((nearest - ends[i].z) / (ends[1 - i].z - ends[i].z));
    const std::vector<Point2d> pixels = lens.project({ends[0], ends[1]});
    const double length = norm(segment.end - segment.begin);
    const Point2d along = (segment.end - segment.begin) / length, across(-along.y, along.x);
    // Places along the segment from its beginning, in pixels.
    const double from = along.dot(pixels[0] - segment.begin), to = along.dot(pixels[1] - segment.begin);
    const double begin = std::max(from, 0.), end = std::min(to, length);
    if (!(to - from > std::cos(MAX_TURN * CV_PI / 180) * norm(pixels[1] - pixels[0])) ||
            end - begin < MIN_SHARE * std::min(length, to - from))
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
    for (const DMatch& m : nearest(lines, codes, segments.codes, SEEN_BITS, fit))
        for (const Match& end : ends(m.queryIdx, m.trainIdx))
            matches.push_back(end);
    return matches;
}

}  // namespace cv::iib
