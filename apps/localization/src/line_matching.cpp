// SPDX-License-Identifier: Apache-2.0

#include "line_matching.hpp"

#include <algorithm>

#include "opencv2/core/hal/hal.hpp"

namespace iib_localization {
namespace {

constexpr double NEAREST = 0.1;        // metres before the camera, where lines are cut off
constexpr double MAX_ANGLE = 5;        // degrees
constexpr double MIN_OVERLAP = 10;     // pixels
constexpr double MIN_SHARE = 1 / 3.;   // of the shorter of line and segment
constexpr int MAX_CODE_DISTANCE = 80;  // bits of 256
constexpr double INLIER_DISTANCE = 2;  // pixels

//! Distances of a line's ends from its segment.
Eigen::Vector2d distances(const LineObservation& line, const Pinhole& camera, const Pose& pose)
{
    return {line.segment.distance(camera.project(pose.toCamera(line.begin))),
            line.segment.distance(camera.project(pose.toCamera(line.end)))};
}

}  // namespace

std::optional<LineObservation> seenAs(const Eigen::Vector3d& begin, const Eigen::Vector3d& end,
        const Segment& segment, const Pinhole& camera, const Pose& pose, double maxDistance)
{
    Eigen::Vector3d a = pose.toCamera(begin), b = pose.toCamera(end);
    if (std::max(a.z(), b.z()) < 2 * NEAREST)
        return std::nullopt;
    if (a.z() < NEAREST)
        a += (b - a) * ((NEAREST - a.z()) / (b.z() - a.z()));
    if (b.z() < NEAREST)
        b += (a - b) * ((NEAREST - b.z()) / (a.z() - b.z()));
    const Segment seen = {camera.project(a), camera.project(b)};
    const Eigen::Vector2d along = segment.direction();
    if (seen.direction().dot(along) < std::cos(MAX_ANGLE * CV_PI / 180))
        return std::nullopt;
    // along the segment from its beginning, in pixels
    const double seenFrom = along.dot(seen.begin - segment.begin),
                 seenTo = along.dot(seen.end - segment.begin);
    const double from = std::max(0., seenFrom), to = std::min(segment.length(), seenTo);
    if (to - from < std::max(MIN_OVERLAP, MIN_SHARE * std::min(segment.length(), seenTo - seenFrom)))
        return std::nullopt;
    const auto at = [&](double place) -> Eigen::Vector3d {
        // the inverse depth is linear in the image
        const double share = (place - seenFrom) / (seenTo - seenFrom);
        const double weight = share / b.z();
        return a + (b - a) * (weight / (weight + (1 - share) / a.z()));
    };
    const Eigen::Vector3d first = at(from), last = at(to);
    if (std::abs(segment.distance(camera.project(first))) > maxDistance ||
            std::abs(segment.distance(camera.project(last))) > maxDistance)
        return std::nullopt;
    return LineObservation{pose.toWorld(first), pose.toWorld(last), segment};
}

std::vector<LineObservation> matchLines(const std::vector<Line3>& lines, const DescribedSegments& image,
        const Pinhole& camera, const Pose& pose, double maxDistance)
{
    struct Match
    {
        int codeDistance = MAX_CODE_DISTANCE + 1;
        size_t index = 0;
    };
    const auto seen = [&](size_t line, size_t segment) {
        return seenAs(lines[line].begin, lines[line].end, image.segments[segment], camera, pose, maxDistance);
    };
    std::vector<Match> best(image.segments.size());  // line of each segment
    for (size_t l = 0; l < lines.size(); l++)
    {
        Match nearest;  // segment
        for (size_t s = 0; s < image.segments.size(); s++)
        {
            const int distance =
                    cv::hal::normHamming(lines[l].code, image.codes.ptr(int(s)), image.codes.cols);
            if (distance < nearest.codeDistance && seen(l, s))
                nearest = {distance, s};
        }
        if (nearest.codeDistance <= MAX_CODE_DISTANCE &&
                nearest.codeDistance < best[nearest.index].codeDistance)
            best[nearest.index] = {nearest.codeDistance, l};
    }
    std::vector<LineObservation> matches;
    for (size_t s = 0; s < best.size(); s++)
        if (best[s].codeDistance <= MAX_CODE_DISTANCE)
            matches.push_back(*seen(best[s].index, s));
    return matches;
}

std::vector<LineObservation> agreeing(
        const std::vector<LineObservation>& matches, const Pinhole& camera, const Pose& pose)
{
    std::vector<LineObservation> inliers;
    for (const LineObservation& o : matches)
        if (std::min(pose.toCamera(o.begin).z(), pose.toCamera(o.end).z()) > NEAREST / 2 &&
                distances(o, camera, pose).cwiseAbs().maxCoeff() < INLIER_DISTANCE)
            inliers.push_back(o);
    return inliers;
}

double deviation(const std::vector<LineObservation>& lines, const Pinhole& camera, const Pose& pose)
{
    std::vector<double> errors;
    for (const LineObservation& o : lines)
        for (double d : distances(o, camera, pose))
            errors.push_back(std::abs(d));
    std::nth_element(errors.begin(), errors.begin() + std::ptrdiff_t(errors.size() / 2), errors.end());
    return errors[errors.size() / 2] / 0.6745;  // the median of a normal distribution's absolute value
}

}  // namespace iib_localization
