// SPDX-License-Identifier: Apache-2.0

#include "line_tracks.hpp"

#include <algorithm>
#include <optional>
#include <set>

#include "opencv2/core/hal/hal.hpp"

#include "line_matching.hpp"
#include "tracks.hpp"

namespace iib_localization {
namespace {

constexpr int MAX_CODE_DISTANCE = 60;   // bits of 256
constexpr double MIN_PARALLAX = 1;      // degrees between the planes
constexpr double MAX_ERROR = 2;         // pixels
constexpr double MIN_OVERLAP = 1 / 3.;  // of the shorter of two sights of a line
constexpr size_t MIN_SIGHTS = 3;

//! What a keyframe sees.
struct View
{
    Pinhole camera;
    Pose pose;
    DescribedSegments image;

    Eigen::Vector3d ray(const Eigen::Vector2d& pixel) const { return pose.rotation * camera.ray(pixel); }
    //! Of the plane through the camera and the segment.
    Eigen::Vector3d normal(const Segment& s) const { return ray(s.begin).cross(ray(s.end)).normalized(); }
};

//! A segment of a view.
struct Place
{
    int view, segment;
    bool operator<(const Place& o) const { return std::tie(view, segment) < std::tie(o.view, o.segment); }
};

struct InfiniteLine
{
    Eigen::Vector3d point, direction;

    //! Where along the line it is nearest to a pixel's ray, in metres.
    double at(const View& view, const Eigen::Vector2d& pixel) const
    {
        const Eigen::Vector3d ray = view.ray(pixel).normalized(), offset = view.pose.position - point;
        const double cosine = ray.dot(direction);
        return (offset.dot(direction) - cosine * offset.dot(ray)) / (1 - cosine * cosine);
    }
};

struct Hypothesis
{
    MapLine line;
    std::vector<Place> places;
};

class LineTriangulator
{
public:
    LineTriangulator(const std::vector<LineFeatures>& features, const Model& model)
    {
        for (size_t k = 0; k < features.size(); k++)
        {
            const Keyframe& keyframe = model.keyframes[k];
            const Camera& camera = model.cameras.at(keyframe.camera);
            views_.push_back({camera.pinhole(), keyframe.pose,
                    {undistorted(features[k].segments, camera), features[k].codes}});
        }
        neighbours_.resize(views_.size());
        for (const auto& [i, j] : nearPairs(model.keyframes))
        {
            neighbours_[size_t(i)].push_back(j);
            neighbours_[size_t(j)].push_back(i);
        }
    }

    std::vector<Hypothesis> hypotheses() const
    {
        std::vector<Hypothesis> result;
        for (int i = 0; i < int(views_.size()); i++)
            for (int j : neighbours_[size_t(i)])
                for (int s = 0; j > i && s < int(segments(i).size()); s++)
                    if (std::optional<Hypothesis> h = best({i, s}, j))
                        if (seeElsewhere(*h))
                            result.push_back(*h);
        return result;
    }

private:
    const std::vector<Segment>& segments(int view) const { return views_[size_t(view)].image.segments; }
    const Segment& segment(const Place& p) const { return segments(p.view)[size_t(p.segment)]; }
    const uchar* code(const Place& p) const { return views_[size_t(p.view)].image.codes.ptr(p.segment); }
    int distance(const Place& a, const Place& b) const
    {
        return cv::hal::normHamming(code(a), code(b), views_[size_t(a.view)].image.codes.cols);
    }

    //! The segment of another view with the nearest code that makes a line, if it is mutual.
    std::optional<Hypothesis> best(const Place& place, int view) const
    {
        const auto [other, hypothesis] = nearest(place, view);
        if (!hypothesis || nearest(other, place.view).first.segment != place.segment)
            return std::nullopt;
        return hypothesis;
    }

    std::pair<Place, std::optional<Hypothesis>> nearest(const Place& place, int view) const
    {
        std::pair<Place, std::optional<Hypothesis>> result;
        int least = MAX_CODE_DISTANCE + 1;
        for (int s = 0; s < int(segments(view).size()); s++)
        {
            const Place other = {view, s};
            const int d = distance(place, other);
            if (d >= least)
                continue;
            if (const std::optional<MapLine> line = fit({place, other}))
            {
                least = d;
                result = {other, Hypothesis{*line, {place, other}}};
            }
        }
        return result;
    }

    //! The line nearest to the planes of all sights, as far as they reach; none if they do not agree on one.
    std::optional<MapLine> fit(const std::vector<Place>& places) const
    {
        Eigen::Matrix3d a = Eigen::Matrix3d::Zero();
        Eigen::Vector3d b = Eigen::Vector3d::Zero();
        for (const Place& p : places)
        {
            const View& view = views_[size_t(p.view)];
            const Eigen::Vector3d n = view.normal(segment(p));
            a += n * n.transpose();
            b += n * n.dot(view.pose.position);
        }
        const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(a);
        // two planes with an angle between them have the eigenvalues 1 - cos and 1 + cos across the line
        if (solver.eigenvalues()[1] < 1 - std::cos(MIN_PARALLAX * CV_PI / 180))
            return std::nullopt;
        InfiniteLine line;
        line.direction = solver.eigenvectors().col(0);
        line.point = (a + line.direction * line.direction.transpose()).ldlt().solve(b);
        const View& first = views_[size_t(places[0].view)];
        if (line.at(first, segment(places[0]).end) < line.at(first, segment(places[0]).begin))
            line.direction = -line.direction;
        return extent(line, places);
    }

    //! The piece of a line that sights see, if each pair of neighbours overlaps, before the cameras.
    std::optional<MapLine> extent(const InfiniteLine& line, const std::vector<Place>& places) const
    {
        double begin = DBL_MAX, end = -DBL_MAX, latestBegin = -DBL_MAX, earliestEnd = DBL_MAX,
               shortest = DBL_MAX;
        for (const Place& p : places)
        {
            const View& view = views_[size_t(p.view)];
            const double from = line.at(view, segment(p).begin), to = line.at(view, segment(p).end);
            if (to <= from)
                return std::nullopt;
            for (double t : {from, to})
                if (view.pose.toCamera(line.point + t * line.direction).z() <= 0)
                    return std::nullopt;
            begin = std::min(begin, from);
            end = std::max(end, to);
            latestBegin = std::max(latestBegin, from);
            earliestEnd = std::min(earliestEnd, to);
            shortest = std::min(shortest, to - from);
        }
        if (places.size() == 2 && earliestEnd - latestBegin < MIN_OVERLAP * shortest)
            return std::nullopt;
        return MapLine{line.point + begin * line.direction, line.point + end * line.direction, {}};
    }

    //! Whether a line would be seen as the segment.
    bool sees(const MapLine& line, const Place& p) const
    {
        const View& view = views_[size_t(p.view)];
        return seenAs(line.begin, line.end, segment(p), view.camera, view.pose, MAX_ERROR).has_value();
    }

    //! Adds the segments of other views that see the line, and fits it again. False if too few agree.
    bool seeElsewhere(Hypothesis& h) const
    {
        const Place first = h.places[0];
        std::set<int> others;
        for (const Place& p : h.places)
            others.insert(neighbours_[size_t(p.view)].begin(), neighbours_[size_t(p.view)].end());
        for (const Place& p : h.places)
            others.erase(p.view);
        for (int view : others)
        {
            Place nearest = {view, -1};
            int least = MAX_CODE_DISTANCE + 1;
            for (int s = 0; s < int(segments(view).size()); s++)
            {
                const int d = distance(first, {view, s});
                if (d < least && sees(h.line, {view, s}))
                {
                    least = d;
                    nearest.segment = s;
                }
            }
            if (nearest.segment >= 0)
                h.places.push_back(nearest);
        }
        if (h.places.size() < MIN_SIGHTS)
            return false;
        const std::optional<MapLine> line = fit(h.places);
        if (!line)
            return false;
        h.line = *line;
        return std::all_of(h.places.begin(), h.places.end(), [&](const Place& p) { return sees(h.line, p); });
    }

    std::vector<View> views_;
    std::vector<std::vector<int>> neighbours_;
};

}  // namespace

LineMap triangulateLines(const std::vector<LineFeatures>& features, const Model& model)
{
    std::vector<Hypothesis> hypotheses = LineTriangulator(features, model).hypotheses();
    std::stable_sort(hypotheses.begin(), hypotheses.end(),
            [](const Hypothesis& a, const Hypothesis& b) { return a.places.size() > b.places.size(); });
    LineMap map;
    for (const LineFeatures& f : features)
        map.codes.emplace_back(0, f.codes.cols, CV_8U);
    std::set<Place> taken;  // a segment is a sight of one line
    for (const Hypothesis& h : hypotheses)
    {
        if (std::any_of(
                    h.places.begin(), h.places.end(), [&](const Place& p) { return taken.count(p) != 0; }))
            continue;
        taken.insert(h.places.begin(), h.places.end());
        map.lines.push_back(h.line);
        for (const Place& p : h.places)
        {
            const LineFeatures& f = features[size_t(p.view)];
            map.lines.back().sights.push_back({p.view, f.segments[size_t(p.segment)]});
            map.codes[size_t(p.view)].push_back(f.codes.row(p.segment));
        }
    }
    return map;
}

}  // namespace iib_localization
