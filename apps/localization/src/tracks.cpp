// SPDX-License-Identifier: Apache-2.0

#include "tracks.hpp"

#include <algorithm>
#include <map>
#include <numeric>

#include "bundle.hpp"
#include "map_builder.hpp"

namespace iib_localization {
namespace {

constexpr size_t NEIGHBOURS = 6;          // keyframes that each is matched with
constexpr float MAX_RATIO = 0.9f;         // of the matches' distances
constexpr double MAX_ANGLE = 60;          // between their axes, degrees
constexpr double MIN_PARALLAX = 1;        // degrees
constexpr double MAX_ERROR = 4;           // pixels, of a first guess
constexpr double MAX_ADJUSTED_ERROR = 2;  // pixels, after bundle adjustment

//! A feature of a keyframe.
struct Place
{
    int keyframe, feature;
    bool operator<(const Place& o) const
    {
        return std::tie(keyframe, feature) < std::tie(o.keyframe, o.feature);
    }
};
typedef std::vector<Place> Track;

class Triangulator
{
public:
    Triangulator(const Model& model, const std::vector<Features>& features) : model_(model)
    {
        for (size_t k = 0; k < features.size(); k++)
            pixels_.push_back(camera(int(k)).undistorted(features[k].pixels));
    }

    const Camera& camera(int keyframe) const { return model_.cameras.at(model_.keyframes[keyframe].camera); }
    const Eigen::Vector2d& pixel(const Place& p) const { return pixels_[p.keyframe][p.feature]; }

    double error(const Place& p, const Eigen::Vector3d& point) const
    {
        const Eigen::Vector3d seen = model_.keyframes[p.keyframe].pose.toCamera(point);
        return seen.z() <= 0 ? DBL_MAX : (camera(p.keyframe).pinhole().project(seen) - pixel(p)).norm();
    }

    //! Leaves out the worst sights until the others agree on a point.
    bool place(Track& track, double maxError, Eigen::Vector3d& point) const
    {
        while (track.size() >= 2)
        {
            std::vector<Pose> poses;
            std::vector<Eigen::Vector3d> rays;
            for (const Place& p : track)
            {
                poses.push_back(model_.keyframes[p.keyframe].pose);
                rays.push_back(camera(p.keyframe).pinhole().ray(pixel(p)));
            }
            if (!triangulate(poses, rays, point))
                return false;
            const auto worst = std::max_element(track.begin(), track.end(),
                    [&](const Place& a, const Place& b) { return error(a, point) < error(b, point); });
            if (error(*worst, point) <= maxError)
                return true;
            track.erase(worst);
        }
        return false;
    }

private:
    const Model& model_;
    std::vector<std::vector<Eigen::Vector2d>> pixels_;
};

//! Joins matched features to tracks, the surest matches first, and never two features of one keyframe.
class TrackForest
{
public:
    explicit TrackForest(const std::vector<Features>& features)
    {
        for (const Features& f : features)
            offsets_.push_back(offsets_.back() + f.pixels.size());
        parent_.resize(offsets_.back());
        std::iota(parent_.begin(), parent_.end(), size_t(0));
        for (int k = 0; k < int(features.size()); k++)
            for (int i = 0; i < int(features[k].pixels.size()); i++)
                tracks_.push_back({{k, i}});
    }

    void join(const Place& a, const Place& b)
    {
        const size_t i = root(a), j = root(b);
        if (i == j)
            return;
        for (const Place& p : tracks_[i])
            for (const Place& q : tracks_[j])
                if (p.keyframe == q.keyframe)
                    return;
        tracks_[i].insert(tracks_[i].end(), tracks_[j].begin(), tracks_[j].end());
        tracks_[j].clear();
        parent_[j] = i;
    }

    const std::vector<Track>& tracks() const { return tracks_; }

private:
    size_t root(const Place& p)
    {
        size_t i = offsets_[p.keyframe] + p.feature;
        while (parent_[i] != i)
            i = parent_[i] = parent_[parent_[i]];
        return i;
    }

    std::vector<size_t> offsets_ = {0}, parent_;
    std::vector<Track> tracks_;
};

TrackForest joinMatches(const FeatureMethod& method, const std::vector<Features>& features,
        const Model& model, const Triangulator& triangulator)
{
    struct Link
    {
        float distance;
        Place a, b;
    };
    std::vector<Link> links;
    for (const auto& [i, j] : nearPairs(model.keyframes))
        for (const cv::DMatch& m : method.match(features[i], features[j], MAX_RATIO))
        {
            const Track both = {{i, m.queryIdx}, {j, m.trainIdx}};
            Track placed = both;
            Eigen::Vector3d point;
            if (triangulator.place(placed, MAX_ERROR, point))
                links.push_back({m.distance, both[0], both[1]});
        }
    std::stable_sort(
            links.begin(), links.end(), [](const Link& a, const Link& b) { return a.distance < b.distance; });
    TrackForest forest(features);
    for (const Link& link : links)
        forest.join(link.a, link.b);
    return forest;
}

}  // namespace

std::set<std::pair<int, int>> nearPairs(const std::vector<Keyframe>& keyframes)
{
    std::set<std::pair<int, int>> pairs;
    for (int i = 0; i < int(keyframes.size()); i++)
    {
        std::vector<std::pair<double, int>> others;
        for (int j = 0; j < int(keyframes.size()); j++)
        {
            const Pose &a = keyframes[i].pose, &b = keyframes[j].pose;
            const double cosine =
                    (a.rotation * Eigen::Vector3d::UnitZ()).dot(b.rotation * Eigen::Vector3d::UnitZ());
            if (j != i && cosine > std::cos(MAX_ANGLE * CV_PI / 180))
                others.emplace_back((a.position - b.position).norm(), j);
        }
        std::sort(others.begin(), others.end());
        for (size_t n = 0; n < std::min(others.size(), NEIGHBOURS); n++)
            pairs.insert({std::min(i, others[n].second), std::max(i, others[n].second)});
    }
    return pairs;
}

bool triangulate(
        const std::vector<Pose>& poses, const std::vector<Eigen::Vector3d>& rays, Eigen::Vector3d& point)
{
    Eigen::Matrix3d a = Eigen::Matrix3d::Zero();
    Eigen::Vector3d b = Eigen::Vector3d::Zero();
    double parallax = 0;
    std::vector<Eigen::Vector3d> directions;
    for (size_t i = 0; i < poses.size(); i++)
    {
        directions.push_back((poses[i].rotation * rays[i]).normalized());
        // the squared distance from the ray is a quadratic form of the projection across it
        const Eigen::Matrix3d across =
                Eigen::Matrix3d::Identity() - directions[i] * directions[i].transpose();
        a += across;
        b += across * poses[i].position;
        for (size_t j = 0; j < i; j++)
            parallax = std::max(parallax,
                    std::atan2(directions[i].cross(directions[j]).norm(), directions[i].dot(directions[j])));
    }
    if (parallax < MIN_PARALLAX * CV_PI / 180)
        return false;
    point = a.ldlt().solve(b);
    for (size_t i = 0; i < poses.size(); i++)
        if (directions[i].dot(point - poses[i].position) <= 0)
            return false;
    return true;
}

std::vector<std::vector<int>> triangulateTracks(
        const FeatureMethod& method, const std::vector<Features>& features, bool refinePoses, Model& model)
{
    if (model.keyframes.size() < 2)
        CV_Error(cv::Error::StsError,
                "points can be triangulated between two or more keyframes only: give --depth");
    const Triangulator triangulator(model, features);
    std::vector<Track> tracks;
    std::vector<Eigen::Vector3d> points;
    const TrackForest forest = joinMatches(method, features, model, triangulator);
    for (Track track : forest.tracks())
    {
        Eigen::Vector3d point;
        if (triangulator.place(track, MAX_ERROR, point))
        {
            tracks.push_back(track);
            points.push_back(point);
        }
    }

    std::vector<Sight> sights;
    for (size_t i = 0; i < tracks.size(); i++)
        for (const Place& p : tracks[i])
            sights.push_back(
                    {p.keyframe, int(i), triangulator.camera(p.keyframe).pinhole(), triangulator.pixel(p)});
    std::vector<Pose> poses;
    for (const Keyframe& k : model.keyframes)
        poses.push_back(k.pose);
    adjustBundle(sights, poses, points, refinePoses);
    for (size_t k = 0; k < poses.size(); k++)
        model.keyframes[k].pose = {poses[k].rotation.normalized(), poses[k].position};

    std::vector<std::vector<int>> pointOf;
    for (const Features& f : features)
        pointOf.emplace_back(f.pixels.size(), -1);
    for (size_t i = 0; i < tracks.size(); i++)
    {
        double worst = 0;
        for (const Place& p : tracks[i])
            worst = std::max(worst, triangulator.error(p, points[i]));
        if (worst > MAX_ADJUSTED_ERROR)
            continue;
        for (const Place& p : tracks[i])
            pointOf[p.keyframe][p.feature] = int(model.points.size());
        model.points.push_back(points[i]);
    }
    return pointOf;
}

}  // namespace iib_localization
