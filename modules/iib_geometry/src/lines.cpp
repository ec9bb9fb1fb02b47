// SPDX-License-Identifier: Apache-2.0

#include "lines.hpp"

#include <algorithm>
#include <cfloat>
#include <set>

#include "features.hpp"
#include "triangulation.hpp"

namespace iib_localization {
namespace {

constexpr double DEVIATION = .7;                 // pixels, of two segments' ends together
constexpr double MAX_UNCERTAINTY = .05;          // of a line's ends, in parts of their distance
constexpr double MAX_ERROR = 3;                  // pixels between a line and a segment that it was made of
constexpr double MAX_TURN = 5;                   // degrees between a segment and a line as it is seen
constexpr double MIN_SHARE = 1. / 3;             // of the shorter of both, that overlaps
constexpr double NEAREST = .05;                  // of the farther end's depth: where lines are cut off
constexpr int MAPPED_BITS = 60, SEEN_BITS = 80;  // in which codes of one line differ, in like and other light

//! The rays to the begin and the end of each segment, by image.
typedef std::vector<std::vector<Ray>> Ends;

/** The line that a track's longest segment shows, its ends where the planes through the others cut the rays to them.
@return false if it is behind a camera, or DEVIATION would move it by more than so many parts of its distance. */
bool placeLine(const Track& track, const Ends& ends, MapLine& line, double maxUncertainty)
{
    const auto rays = [&](const Ray& r) { return &ends[r.image][2 * size_t(r.keypoint)]; };
    const auto normal = [&](const Ray& r) { return rays(r)[0].direction.cross(rays(r)[1].direction); };
    const Ray& longest = *std::max_element(track.begin(), track.end(),
            [&](const Ray& a, const Ray& b) { return cv::norm(normal(a)) < cv::norm(normal(b)); });
    for (int i : {0, 1})
    {
        const Ray& ray = rays(longest)[i];
        double squares = 0, sum = 0;
        for (const Ray& other : track)
            if (&other != &longest)
            {
                const cv::Vec3d plane = cv::normalize(normal(other));
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

}  // namespace

void addLines(
        Map& map, const std::vector<Segments>& segments, const std::vector<std::pair<size_t, size_t>>& pairs)
{
    Ends ends;
    std::vector<Ray> all;
    std::vector<size_t> first;  // of each image's, among all
    std::vector<Lens> lenses;
    for (size_t i = 0; i < map.images.size(); i++)
    {
        PosedImage image;
        image.camera = map.images[i].camera;
        image.cameraFromWorld = map.images[i].cameraFromWorld;
        for (const Segment& s : segments[i].places)
            image.pixels.insert(image.pixels.end(), {s.begin, s.end});
        ends.push_back(raysOf(i, image));
        lenses.emplace_back(image.camera);
        first.push_back(all.size());
        for (size_t s = 0; s < segments[i].places.size(); s++)
        {
            all.push_back(ends[i][2 * s]);
            all.back().keypoint = int(s);
        }
    }
    const auto shows = [&](const Ray& ray, const MapLine& line) {
        return !matchesOf(line, segments[ray.image].places[size_t(ray.keypoint)], lenses[ray.image],
                map.images[ray.image].cameraFromWorld, MAX_ERROR)
                        .empty();
    };
    std::vector<std::vector<Link>> found(pairs.size());
    inParallel(pairs.size(), [&](size_t n) {
        const size_t a = pairs[n].first, b = pairs[n].second;
        if (segments[a].codes.empty() || segments[b].codes.empty())
            return;
        cv::Mat bits;
        cv::batchDistance(
                segments[a].codes, segments[b].codes, bits, CV_32S, cv::noArray(), cv::NORM_HAMMING);
        cv::Mat_<float> away = bits, ofFirst, ofSecond;
        const auto link = [&](int s, int t) {
            return Link{away(s, t), first[a] + size_t(s), first[b] + size_t(t)};
        };
        for (int s = 0; s < away.rows; s++)
            for (int t = 0; t < away.cols; t++)
            {
                const Ray &one = all[link(s, t).a], &other = all[link(s, t).b];
                MapLine line;
                if (away(s, t) > MAPPED_BITS || !placeLine({one, other}, ends, line, HUGE_VAL) ||
                        !shows(one, line) || !shows(other, line))
                    away(s, t) = FLT_MAX;
            }
        cv::reduce(away, ofFirst, 1, cv::REDUCE_MIN);
        cv::reduce(away, ofSecond, 0, cv::REDUCE_MIN);
        for (int s = 0; s < away.rows; s++)
            for (int t = 0; t < away.cols; t++)
                if (away(s, t) < FLT_MAX && away(s, t) == ofFirst(s) && away(s, t) == ofSecond(t))
                    found[n].push_back(link(s, t));
    });
    std::vector<Link> links;
    for (const std::vector<Link>& some : found)
        links.insert(links.end(), some.begin(), some.end());
    for (Track& track : joined(all, links))
    {
        MapLine line;
        for (size_t before = 0; before != track.size() && track.size() > 1;)
        {
            before = track.size();
            if (!placeLine(track, ends, line, MAX_UNCERTAINTY))
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
            map.images[ray.image].lineCodes.push_back(segments[ray.image].codes.row(ray.keypoint));
        }
        map.lines.push_back(line);
    }
}

std::vector<Match> matchesOf(
        const MapLine& line, const Segment& segment, const Lens& lens, const cv::Affine3d& pose, double limit)
{
    cv::Point3d ends[] = {pose * line.begin, pose * line.end};
    const double nearest = NEAREST * std::max(ends[0].z, ends[1].z);
    for (int i : {0, 1})  // cuts off what is behind the camera
        if (ends[i].z < nearest && nearest > 0)
            ends[i] += (ends[1 - i] - ends[i]) * ((nearest - ends[i].z) / (ends[1 - i].z - ends[i].z));
    const std::vector<cv::Point2d> pixels = lens.project({ends[0], ends[1]});
    const double length = cv::norm(segment.end - segment.begin);
    const cv::Point2d along = (segment.end - segment.begin) / length, across(-along.y, along.x);
    // Places along the segment from its beginning, in pixels.
    const double from = along.dot(pixels[0] - segment.begin), to = along.dot(pixels[1] - segment.begin);
    const double begin = std::max(from, 0.), end = std::min(to, length);
    if (!(to - from > std::cos(MAX_TURN * CV_PI / 180) * cv::norm(pixels[1] - pixels[0])) ||
            end - begin < MIN_SHARE * std::min(length, to - from))
        return {};
    std::vector<Match> matches;
    for (double place : {begin, end})
    {
        const double share = (place - from) / (to - from);  // in the image
        const double part = share * ends[0].z / (ends[1].z + share * (ends[0].z - ends[1].z));
        const cv::Point3d point = ends[0] + (ends[1] - ends[0]) * part;
        matches.push_back({segment.begin + along * place, inverse(pose) * point});
        matches.back().counted = cv::Matx22d(
                across.x * across.x, across.x * across.y, across.x * across.y, across.y * across.y);
        if (!(std::abs(across.dot(lens.project({point})[0] - matches.back().pixel)) < limit))
            return {};
    }
    return matches;
}

std::vector<Match> lineMatches(const Map& map, const std::vector<size_t>& images, const Segments& segments,
        const Lens& lens, const Frame& frame, const cv::Affine3d& pose, double limit)
{
    struct Candidate
    {
        int bits, line, segment;
        std::vector<Match> ends;
    };
    std::vector<Candidate> candidates;
    for (size_t i : images)
    {
        const MapImage& image = map.images[i];
        cv::Mat_<int> bits;
        if (!image.lines.empty())
            cv::batchDistance(image.lineCodes, segments.codes, bits, CV_32S, cv::noArray(), cv::NORM_HAMMING);
        for (int row = 0; row < bits.rows; row++)
        {
            const int number = image.lines[size_t(row)];
            const MapLine& line = map.lines[size_t(number)];
            const MapLine local = {frame.toLocal(line.begin), frame.toLocal(line.end)};
            for (int s = 0; s < bits.cols; s++)
                if (bits(row, s) <= SEEN_BITS)
                    candidates.push_back({bits(row, s), number, s,
                            matchesOf(local, segments.places[size_t(s)], lens, pose, limit)});
        }
    }
    std::stable_sort(candidates.begin(), candidates.end(),
            [](const Candidate& a, const Candidate& b) { return a.bits < b.bits; });
    std::set<int> lines, taken;
    std::vector<Match> matches;
    for (const Candidate& c : candidates)
        if (!c.ends.empty() && taken.count(c.segment) == 0 && lines.insert(c.line).second)
        {
            taken.insert(c.segment);
            matches.insert(matches.end(), c.ends.begin(), c.ends.end());
        }
    return matches;
}

}  // namespace iib_localization
