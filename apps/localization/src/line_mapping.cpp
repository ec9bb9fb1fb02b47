// SPDX-License-Identifier: Apache-2.0

#include "line_mapping.hpp"

#include "map_builder.hpp"

namespace iib_localization {
namespace {

constexpr double STEP = 2;              // pixels between depths along a segment
constexpr double ASIDE = 3;             // pixels to either side of a segment, at an edge of the depth
constexpr double MAX_DEVIATION = 0.01;  // of a depth from the line's, as a share
constexpr double MIN_SHARE = 0.75;      // of the depths along a segment
constexpr size_t MIN_DEPTHS = 6;

//! Inverse depth at a place along a segment, in pixels from its beginning.
struct Sample
{
    double place, inverse;
};

//! Inverse depth is linear along a line.
struct Slope
{
    double start, change;

    double at(double place) const { return start + change * place; }
    bool agrees(const Sample& s) const { return std::abs(at(s.place) / s.inverse - 1) < MAX_DEVIATION; }
};

std::vector<Sample> samplesAlong(const Segment& straight, const Camera& camera, const cv::Mat& millimetres)
{
    std::vector<Sample> samples;
    const Eigen::Vector2d along = straight.direction(), across(-along.y(), along.x());
    const auto depth = [&](double place, double aside) {
        const Eigen::Vector2d p = camera.distorted(straight.begin + place * along + aside * across);
        return depthAt(millimetres, {float(p.x()), float(p.y())});
    };
    for (double place = 0; place <= straight.length(); place += STEP)
    {
        double z = depth(place, 0);
        if (z == 0)
        {
            const double left = depth(place, -ASIDE), right = depth(place, ASIDE);
            z = left == 0 || (right != 0 && right < left) ? right : left;
        }
        if (z != 0)
            samples.push_back({place, 1 / z});
    }
    return samples;
}

std::vector<Sample> agreeing(const std::vector<Sample>& samples, const Slope& slope)
{
    std::vector<Sample> result;
    for (const Sample& s : samples)
        if (slope.agrees(s))
            result.push_back(s);
    return result;
}

Slope leastSquares(const std::vector<Sample>& samples)
{
    Eigen::Matrix2d a = Eigen::Matrix2d::Zero();
    Eigen::Vector2d b = Eigen::Vector2d::Zero();
    for (const Sample& s : samples)
    {
        const Eigen::Vector2d row(1, s.place);
        a += row * row.transpose();
        b += row * s.inverse;
    }
    const Eigen::Vector2d x = a.ldlt().solve(b);
    return {x[0], x[1]};
}

//! The samples that agree best: of the slopes through all pairs of samples half the line or more apart.
std::vector<Sample> bestAgreeing(const std::vector<Sample>& samples, double length)
{
    std::vector<Sample> best;
    for (const Sample& a : samples)
        for (const Sample& b : samples)
        {
            if (b.place - a.place < length / 2)
                continue;
            const double change = (b.inverse - a.inverse) / (b.place - a.place);
            std::vector<Sample> inliers = agreeing(samples, {a.inverse - change * a.place, change});
            if (inliers.size() > best.size())
                best = inliers;
        }
    return best;
}

}  // namespace

std::optional<MapLine> lineFromDepth(
        const Segment& straight, const Camera& camera, const Pose& pose, const cv::Mat& millimetres)
{
    const std::vector<Sample> samples = samplesAlong(straight, camera, millimetres);
    const std::vector<Sample> inliers = bestAgreeing(samples, straight.length());
    const double all = straight.length() / STEP;
    if (inliers.size() < MIN_DEPTHS || double(inliers.size()) < MIN_SHARE * all)
        return std::nullopt;
    const Slope slope = leastSquares(inliers);
    const auto at = [&](const Sample& s) {
        const Eigen::Vector2d pixel = straight.begin + s.place * straight.direction();
        return pose.toWorld(camera.pinhole().ray(pixel) / slope.at(s.place));
    };
    return MapLine{at(inliers.front()), at(inliers.back()), {}};
}

void addLinesFromDepth(LineMap& map, const LineFeatures& features, const Camera& camera, const Pose& pose,
        const cv::Mat& millimetres)
{
    const int keyframe = int(map.codes.size());
    cv::Mat codes(0, features.codes.cols, CV_8U);
    const std::vector<Segment> straight = undistorted(features.segments, camera);
    for (size_t i = 0; i < straight.size(); i++)
        if (std::optional<MapLine> line = lineFromDepth(straight[i], camera, pose, millimetres))
        {
            line->sights = {{keyframe, features.segments[i]}};
            map.lines.push_back(*line);
            codes.push_back(features.codes.row(int(i)));
        }
    map.codes.push_back(codes);
}

}  // namespace iib_localization
