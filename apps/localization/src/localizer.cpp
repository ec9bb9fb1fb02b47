// SPDX-License-Identifier: Apache-2.0

#include "localizer.hpp"

#include <algorithm>
#include <numeric>

#include "line_features.hpp"
#include "pnp.hpp"

namespace iib_localization {
namespace {

constexpr size_t SHORTLIST = 20;  // keyframes by votes, of which
constexpr size_t CANDIDATES = 5;  // keyframes that an image is matched with
constexpr int STRONGEST = 400;    // of an image and detector, whose matches rank the shortlist
constexpr size_t MIN_MATCHES = 12;
// In an unknown place up to 20 of 1100 matches agree by chance. A pose needs 15 and a share of the matches.
constexpr size_t MIN_INLIERS = 15;
constexpr double MIN_INLIER_SHARE = 0.02;
constexpr double MAX_BOUND = 1;  // metres
constexpr size_t MIN_LINES = 5;  // fewer do not tell their noise
constexpr double MAX_LINE_WEIGHT = 3;
constexpr double LINE_GATE = 4;  // pixels, of a line from where the pose of the points has it

//! Milliseconds since the last call.
class Stopwatch
{
public:
    void lap(Location& location)
    {
        const int64 now = cv::getTickCount();
        location.times.push_back(double(now - last_) / cv::getTickFrequency() * 1e3);
        last_ = now;
    }

private:
    int64 last_ = cv::getTickCount();
};

//! The residuals' standard deviation in a coordinate, from their median, so that a few wrong ones do not count.
double deviation(const std::vector<Observation>& inliers, const Pinhole& camera, const Pose& pose)
{
    std::vector<double> errors;
    for (const Observation& o : inliers)
        errors.push_back((camera.project(pose.toCamera(o.point)) - o.pixel).norm());
    std::nth_element(errors.begin(), errors.begin() + std::ptrdiff_t(errors.size() / 2), errors.end());
    return errors[errors.size() / 2] / 1.1774;  // the median of a Rayleigh distribution
}

double worstDeviation(const Eigen::Matrix3d& covariance)
{
    return std::sqrt(Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(covariance, Eigen::EigenvaluesOnly)
                             .eigenvalues()[2]);
}

}  // namespace

const std::vector<std::string>& Location::stages()
{
    static const std::vector<std::string> names = {"features", "retrieval", "matching", "pose", "lines"};
    return names;
}

Localizer::Localizer(const Map& map, const Camera& camera, Lines lines)
    : map_(map), camera_(camera), pinhole_(camera.pinhole()), method_(map.features)
{
    if (map.description != method_.description())
        CV_Error(cv::Error::StsError, "the map is of '" + map.description + "', this program makes '" +
                                              method_.description() + "': build the map again");
    for (size_t d = 0; method_.binary() && d < method_.detectors(); d++)
    {
        std::vector<cv::Mat> codes;
        for (const std::vector<cv::Mat>& keyframe : map.codes)
            codes.push_back(keyframe[d]);
        retrievals_.emplace_back(codes);
    }
    if (lines == Lines::ON && linesAvailable() && !map.lines.lines.empty())
        linesOf_ = linesOfKeyframes(map.lines.lines, map.model.keyframes.size());
}

size_t Localizer::retrievalBytes() const
{
    size_t sum = 0;
    for (const Retrieval& retrieval : retrievals_)
        sum += retrieval.bytes();
    return sum;
}

std::vector<size_t> Localizer::candidates(const Features& features, const Pose* prior) const
{
    const std::vector<Keyframe>& keyframes = map_.model.keyframes;
    std::vector<size_t> order(keyframes.size());
    std::iota(order.begin(), order.end(), size_t(0));
    std::vector<float> votes(keyframes.size(), 0.f);
    for (size_t k = 0; prior && k < votes.size(); k++)
    {
        // a metre counts as much as 30 degrees
        const Pose& pose = keyframes[k].pose;
        votes[k] = -float((pose.position - prior->position).norm() +
                          pose.rotation.angularDistance(prior->rotation) * 6 / CV_PI);
    }
    for (size_t d = 0; !prior && d < retrievals_.size(); d++)
        retrievals_[d].vote(features.codes[d], votes);
    const auto keepBest = [&](size_t limit) {
        const size_t count = std::min(order.size(), limit);
        std::partial_sort(order.begin(), order.begin() + std::ptrdiff_t(count), order.end(),
                [&](size_t a, size_t b) { return votes[a] > votes[b]; });
        order.resize(count);
    };
    if (!prior)
    {
        if (!retrievals_.empty())  // without binary codes there is no vote: all keyframes are ranked
            keepBest(SHORTLIST);
        for (size_t k : order)
            votes[k] = float(countSureMatches(features, k));
    }
    keepBest(CANDIDATES);
    return order;
}

size_t Localizer::countSureMatches(const Features& features, size_t keyframe) const
{
    size_t count = 0;
    for (size_t d = 0; d < method_.detectors(); d++)
    {
        const cv::Mat &query = features.codes[d], &train = map_.codes[keyframe][d];
        const cv::Range rows(0, std::min(query.rows, STRONGEST));
        const cv::Range columns(0, method_.coarseColumns(query.cols));
        if (!query.empty() && !train.empty())
            count += method_.match(query(rows, columns), train.colRange(columns), method_.sureRatio()).size();
    }
    return count;
}

std::vector<Observation> Localizer::match(
        const Features& features, const std::vector<size_t>& keyframes) const
{
    const std::vector<Eigen::Vector2d> pixels = camera_.undistorted(features.pixels);
    std::vector<Observation> matches;
    for (size_t k : keyframes)
    {
        int firstQuery = 0, firstTrain = 0;  // row of the detector's first keypoint
        for (size_t d = 0; d < method_.detectors(); d++)
        {
            for (const cv::DMatch& m :
                    method_.match(features.codes[d], map_.codes[k][d], method_.poseRatio()))
                matches.push_back({map_.model.points[map_.model.keyframes[k].points[firstTrain + m.trainIdx]],
                        pixels[firstQuery + m.queryIdx]});
            firstQuery += features.codes[d].rows;
            firstTrain += map_.codes[k][d].rows;
        }
    }
    return matches;
}

bool Localizer::estimate(Location& location) const
{
    RefinedPose& refined = location.estimate;
    if (!poseByRansac(location.matched, pinhole_, refined.pose))
    {
        location.reason = "no pose that the matches agree on";
        return false;
    }
    // what agrees is looked for again after each refinement
    for (int round = 0; round < 3; round++)
    {
        location.inliers = agreeing(location.matched, pinhole_, refined.pose);
        if (location.inliers.size() < MIN_INLIERS)
        {
            location.reason = "too few matches agree";
            return false;
        }
        if (!refinePose(pinhole_, location.inliers, refined))
        {
            location.reason = "the points do not determine the pose";
            return false;
        }
    }
    return true;
}

void Localizer::addLines(Location& location, const cv::Mat& grey, const std::vector<size_t>& keyframes) const
{
    const LineFeatures features = extractLines(grey);
    const DescribedSegments image = {undistorted(features.segments, camera_), features.codes};
    std::vector<LineObservation> matches;
    for (size_t k : keyframes)
    {
        std::vector<Line3> lines;
        for (size_t i = 0; i < linesOf_[k].size(); i++)
        {
            const MapLine& line = map_.lines.lines[size_t(linesOf_[k][i])];
            lines.push_back({line.begin, line.end, map_.lines.codes[k].ptr(int(i))});
        }
        const std::vector<LineObservation> found =
                matchLines(lines, image, pinhole_, location.estimate.pose, LINE_GATE);
        matches.insert(matches.end(), found.begin(), found.end());
    }
    Location refined = location;
    for (int round = 0; round < 3; round++)
    {
        const Pose& pose = refined.estimate.pose;
        refined.inliers = agreeing(location.matched, pinhole_, pose);
        refined.lineInliers = round == 0 ? matches : agreeing(matches, pinhole_, pose);
        if (refined.lineInliers.size() < MIN_LINES || refined.inliers.size() < MIN_INLIERS)
            return;
        // each kind counts by its own noise
        const double weight =
                deviation(refined.inliers, pinhole_, pose) / deviation(refined.lineInliers, pinhole_, pose);
        if (!refinePose(pinhole_, refined.inliers, refined.estimate, refined.lineInliers,
                    std::clamp(weight, 1 / MAX_LINE_WEIGHT, MAX_LINE_WEIGHT)))
            return;
    }
    location = refined;
}

void Localizer::judge(Location& location) const
{
    RefinedPose& refined = location.estimate;
    const double sigma = std::max(0.2, deviation(location.inliers, pinhole_, refined.pose));
    refined.covariance *= sigma * sigma / POINT_WEIGHT;
    location.metres = 3 * worstDeviation(refined.covariance.topLeftCorner<3, 3>());
    location.degrees = 3 * worstDeviation(refined.covariance.bottomRightCorner<3, 3>()) * 180 / CV_PI;
    const double needed = double(MIN_INLIERS) + MIN_INLIER_SHARE * double(location.matched.size());
    if (double(location.inliers.size()) < needed)
        location.reason = "too few matches agree";
    else if (location.metres > MAX_BOUND)
        location.reason = "the pose is uncertain";
    else
        location.found = true;
}

Location Localizer::locate(const cv::Mat& grey, const Pose* prior) const
{
    Location location;
    if (grey.empty())
    {
        location.reason = "the image cannot be read";
        return location;
    }
    if (grey.size() != camera_.size)
    {
        location.reason = cv::format("the image has %d x %d pixels and the camera %d x %d", grey.cols,
                grey.rows, camera_.size.width, camera_.size.height);
        return location;
    }
    Stopwatch watch;
    const Features features = method_.extract(grey);
    watch.lap(location);
    const std::vector<size_t> keyframes = candidates(features, prior);
    watch.lap(location);
    location.matched = match(features, keyframes);
    watch.lap(location);
    if (location.matched.size() < MIN_MATCHES)
    {
        location.reason = "too few matches";
        return location;
    }
    const bool estimated = estimate(location);
    watch.lap(location);
    if (estimated && !linesOf_.empty())
    {
        addLines(location, grey, keyframes);
        watch.lap(location);
    }
    if (estimated)
        judge(location);
    return location;
}

}  // namespace iib_localization
