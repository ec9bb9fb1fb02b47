// SPDX-License-Identifier: Apache-2.0

#include "lines.hpp"

#include <algorithm>
#include <map>

namespace iib_localization {
namespace {

constexpr double MAX_TURN = 5;        // degrees between a segment and a line as it is seen
constexpr double MIN_SHARE = 1. / 3;  // of the shorter of both, that overlaps
constexpr double NEAREST = .05;       // of the farther end's depth: where lines are cut off
constexpr int MAX_BITS = 80;          // in which the codes of one line differ
constexpr double DEVIATION = 1;       // pixels, of a segment and its line together

}  // namespace

SeenLine::SeenLine(const MapLine& line, const Lens& lens, const cv::Affine3d& pose)
    : lens_(lens), back_(inverse(pose)), ends_{pose * line.begin, pose * line.end}
{
    const double nearest = NEAREST * std::max(ends_[0].z, ends_[1].z);
    for (cv::Point3d* end : {ends_, ends_ + 1})
    {
        const cv::Point3d& other = ends_[end == ends_];
        if (end->z < nearest && nearest > 0)
            *end += (other - *end) * ((nearest - end->z) / (other.z - end->z));
    }
    pixels_ = lens.project({ends_[0], ends_[1]});
}

std::vector<Match> SeenLine::matchesWith(const Segment& segment, double limit) const
{
    const double length = cv::norm(segment.end - segment.begin);
    const cv::Point2d along = (segment.end - segment.begin) / length, across(-along.y, along.x);
    // Places along the segment from its beginning, in pixels.
    const double from = along.dot(pixels_[0] - segment.begin), to = along.dot(pixels_[1] - segment.begin);
    if (!(to - from > std::cos(MAX_TURN * CV_PI / 180) * cv::norm(pixels_[1] - pixels_[0])))
        return {};
    const double begin = std::max(from, 0.), end = std::min(to, length);
    if (end - begin < MIN_SHARE * std::min(length, to - from))
        return {};
    std::vector<Match> matches;
    std::vector<cv::Point3d> points;
    for (double place : {begin, end})
    {
        const double share = (place - from) / (to - from);  // in the image
        const double part = share * ends_[0].z / (ends_[1].z + share * (ends_[0].z - ends_[1].z));
        points.push_back(ends_[0] + (ends_[1] - ends_[0]) * part);
        matches.push_back({segment.begin + along * place, back_ * points.back()});
        matches.back().counted = cv::Matx22d(
                across.x * across.x, across.x * across.y, across.x * across.y, across.y * across.y);
        matches.back().deviation = DEVIATION;
    }
    const std::vector<cv::Point2d> seen = lens_.project(points);
    for (size_t i = 0; i < 2; i++)
        if (!(std::abs(across.dot(seen[i] - matches[i].pixel)) < limit))
            return {};
    return matches;
}

std::vector<Match> lineMatches(const Map& map, const std::vector<size_t>& images, const Segments& segments,
        const Lens& lens, const Frame& frame, const cv::Affine3d& pose, double limit)
{
    struct Best
    {
        int bits = MAX_BITS + 1;
        size_t segment = 0;
        std::vector<Match> matches;
    };
    std::map<int, SeenLine> seen;
    std::map<int, Best> byLine;
    std::vector<int> least(segments.places.size(), MAX_BITS + 1);  // bits of each segment's best line
    for (size_t i : images)
    {
        const MapImage& image = map.images[i];
        for (size_t row = 0; row < image.lines.size(); row++)
        {
            const int number = image.lines[row];
            const MapLine& line = map.lines[size_t(number)];
            const SeenLine& there =
                    seen.try_emplace(number, MapLine{frame.toLocal(line.begin), frame.toLocal(line.end)},
                                lens, pose)
                            .first->second;
            for (size_t s = 0; s < segments.places.size(); s++)
            {
                const int bits = codeDistance(segments.codes, int(s), image.lineCodes, int(row));
                if (bits >= byLine[number].bits)
                    continue;
                std::vector<Match> matches = there.matchesWith(segments.places[s], limit);
                if (matches.empty())
                    continue;
                byLine[number] = {bits, s, matches};
                least[s] = std::min(least[s], bits);
            }
        }
    }
    std::vector<Match> result;
    for (const auto& [number, best] : byLine)
        if (!best.matches.empty() && best.bits == least[best.segment])
            result.insert(result.end(), best.matches.begin(), best.matches.end());
    return result;
}

}  // namespace iib_localization
