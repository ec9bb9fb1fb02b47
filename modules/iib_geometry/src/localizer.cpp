// SPDX-License-Identifier: Apache-2.0

#include <algorithm>
#include <numeric>
#include <set>

#include "features.hpp"
#include "mapping.hpp"
#include "numbers.hpp"
#include "pose.hpp"
#include "retrieval.hpp"

// The steps and numbers are those of Python's opencv_iib.localization.
namespace iib_localization {
namespace {

using cv::iib::Location;

constexpr size_t SHORTLIST = 20, CANDIDATES = 5;  // of the map's images: by votes, and of these by matches
constexpr size_t NEAREST = 2;                     // of the map's images, to a prior
constexpr int RANKING = 200;    // strongest codes of an image, whose matches rank the shortlist
constexpr size_t SUREST = 300;  // matches of the fewest different bits, among which the pose is looked for
constexpr double GATE = .1;  // of the longer side: how far from where a prior has them points are looked for
constexpr double MAX_ERROR =
        .006;  // of the longer side: an inlier's distance from where the pose has its point
constexpr double LEAST_INLIERS = 15, LEAST_SHARE = .02;  // in an unknown place a few matches agree by chance
constexpr double MAX_BOUND = .1;  // of the distance to the points: three standard deviations of the place
constexpr double LEAST_DEVIATION = .2;  // pixels

double medianDistance(const std::vector<cv::Point3d>& pointsInCamera)
{
    std::vector<double> distances;
    for (const cv::Point3d& p : pointsInCamera)
        distances.push_back(cv::norm(p));
    return median(distances);
}

//! What sorts first, of so many.
template <typename Before> std::vector<size_t> best(size_t all, size_t count, Before before)
{
    std::vector<size_t> order(all);
    std::iota(order.begin(), order.end(), size_t(0));
    std::stable_sort(order.begin(), order.end(), before);
    order.resize(std::min(all, count));
    return order;
}

//! Keypoints that match a point in several images of the map count once.
void removeRepeated(std::vector<Match>& matches)
{
    const auto key = [](const Match& m) { return std::make_pair(m.keypoint, m.number); };
    std::stable_sort(
            matches.begin(), matches.end(), [&](const Match& a, const Match& b) { return key(a) < key(b); });
    const auto same = [&](const Match& a, const Match& b) { return key(a) == key(b); };
    matches.erase(std::unique(matches.begin(), matches.end(), same), matches.end());
}

//! The matches within a limit of where a pose has their points.
std::vector<Match> agreeing(
        const std::vector<Match>& matches, const Lens& lens, const cv::Affine3d& pose, double limit)
{
    const std::vector<double> errors = errorsOf(matches, lens, pose);
    std::vector<Match> inliers;
    for (size_t i = 0; i < matches.size(); i++)
        if (errors[i] < limit)  // not NaN, behind the camera
            inliers.push_back(matches[i]);
    return inliers;
}

int keypointsOf(const std::vector<Match>& matches)
{
    std::set<int> keypoints;
    for (const Match& m : matches)
        keypoints.insert(m.keypoint);
    return int(keypoints.size());
}

//! Finds the pose that matches agree on, and whether it is one.
void locate(std::vector<Match> matches, const Camera& camera, Location& location)
{
    removeRepeated(matches);
    location.matches = int(matches.size());
    const Lens lens(camera);
    const double limit = MAX_ERROR * std::max(camera.size.width, camera.size.height);
    std::vector<Match> surest;
    for (size_t i : best(matches.size(), SUREST,
                 [&](size_t a, size_t b) { return matches[a].bits < matches[b].bits; }))
        surest.push_back(matches[i]);
    cv::Affine3d& pose = location.cameraFromWorld;
    location.reason = "too few matches agree";
    if (!poseByRansac(surest, lens, limit, pose))
        return;
    std::vector<Match> inliers;
    for (int round = 0; round < 3; round++)  // what agrees is looked for again after each refinement
    {
        if (round > 0 && !refinePose(inliers, lens, pose, location.covariance))
        {
            location.reason = "the points do not determine the pose";
            return;
        }
        inliers = agreeing(matches, lens, pose, limit);
        location.inliers = keypointsOf(inliers);
        if (location.inliers < LEAST_INLIERS + LEAST_SHARE * double(matches.size()))
            return;
    }
    for (const Match& m : inliers)
    {
        location.pixels.push_back(m.pixel);
        location.points.push_back(m.point);
    }
    // of a Rayleigh distribution
    const double deviation = std::max(LEAST_DEVIATION, median(errorsOf(inliers, lens, pose)) / 1.1774);
    location.covariance *= deviation * deviation;
    cv::Vec3d variances;
    cv::eigen(location.covariance.get_minor<3, 3>(0, 0), variances);
    location.found =
            3 * std::sqrt(variances[0]) <= MAX_BOUND * medianDistance(inCamera(location.points, pose));
    location.reason = location.found ? "" : "the pose is uncertain";
}

}  // namespace
}  // namespace iib_localization

using namespace iib_localization;

struct cv::iib::Localizer::Impl
{
    Impl(Map&& read, int points)
        : map(std::move(read)), iib(IIB::createRecommended(points ? points : map.keypoints)),
          matcher(HierarchicalMatcher::createRecommended())
    {
        if (map.codes.cols != iib->descriptorSize())
            CV_Error(Error::StsError, "the map's codes are not those of this version: make it again");
        std::vector<Mat> codes;
        for (const View& v : map.views)
            codes.push_back(map.codes.rowRange(v.rows));
        votes = std::make_unique<Retrieval>(codes);
    }

    //! The images of the map nearest to a pose: a turn in radians counts as much as a way by their depth.
    std::vector<size_t> near(const Affine3d& pose) const
    {
        std::vector<double> distances;
        const Vec3d centre = pose.inv().translation();
        const Matx33d rotation = pose.rotation();
        const Vec3d direction(rotation.val + 6);
        for (const View& v : map.views)
            distances.push_back(norm(centre - v.centre) / v.depth +
                                std::acos(std::clamp(direction.dot(v.direction), -1., 1.)));
        return best(
                map.views.size(), NEAREST, [&](size_t a, size_t b) { return distances[a] < distances[b]; });
    }

    std::vector<size_t> similar(const Mat& codes) const
    {
        const std::vector<float> voted = votes->vote(codes);
        std::vector<size_t> counts(map.views.size());
        for (size_t k :
                best(counts.size(), SHORTLIST, [&](size_t a, size_t b) { return voted[a] > voted[b]; }))
            if (voted[k] > 0)
            {
                std::vector<DMatch> found;
                matcher->match(codes.rowRange(0, std::min(codes.rows, RANKING)),
                        map.codes.rowRange(map.views[k].rows), found);
                counts[k] = found.size();
            }
        std::vector<size_t> order =
                best(counts.size(), CANDIDATES, [&](size_t a, size_t b) { return counts[a] > counts[b]; });
        order.erase(std::find_if(order.begin(), order.end(), [&](size_t k) { return counts[k] == 0; }),
                order.end());
        return order;
    }

    //! Which keypoints (rows) may match which points (columns): those near where the prior has them.
    static Mat gate(const Features& features, const std::vector<Point3d>& points, const Camera& camera,
            const Affine3d& prior)
    {
        const double limit = std::round(GATE * std::max(camera.size.width, camera.size.height));
        const std::vector<Point2d> places = Lens(camera).project(inCamera(points, prior));
        Mat mask(int(features.pixels.size()), int(places.size()), CV_8U);
        for (int y = 0; y < mask.rows; y++)
            for (int x = 0; x < mask.cols; x++)
            {
                const Point2d way = places[size_t(x)] - features.pixels[size_t(y)];
                mask.at<uchar>(y, x) = std::abs(way.x) < limit && std::abs(way.y) < limit ? 255 : 0;
            }
        return mask;
    }

    Location locate(const Features& features, const Camera& camera, const std::vector<size_t>& candidates,
            const Affine3d* prior) const
    {
        Location location;
        location.reason = "too few matches";
        std::vector<Match> matches;
        for (size_t k : candidates)
        {
            const Range rows = map.views[k].rows;
            const int* const numbers = map.sees.ptr<int>(rows.start);
            std::vector<Point3d> points;
            for (int i = 0; i < rows.size(); i++)
                points.push_back(map.point(numbers[i]));
            std::vector<DMatch> found;
            if (!points.empty())
                matcher->match(features.codes, map.codes.rowRange(rows), found,
                        prior ? gate(features, points, camera, *prior) : Mat());
            for (const DMatch& m : found)
                matches.push_back({features.pixels[size_t(m.queryIdx)], points[size_t(m.trainIdx)],
                        numbers[m.trainIdx], m.queryIdx, int(m.distance)});
        }
        if (matches.size() >= LEAST_INLIERS)
            iib_localization::locate(std::move(matches), camera, location);
        return location;
    }

    const Map map;
    Ptr<IIB> iib;
    Ptr<HierarchicalMatcher> matcher;
    std::unique_ptr<Retrieval> votes;
};

cv::iib::Localizer::Localizer(const std::string& map, int points)
    : impl_(std::make_unique<const Impl>(readMap(map), points))
{
}

cv::iib::Localizer::Localizer(
        const std::string& model, const std::string& photographs, int points, const Report& report)
    : impl_(std::make_unique<const Impl>(buildMap(model, photographs, report), points))
{
}

cv::iib::Localizer::~Localizer() = default;

const std::vector<cv::iib::Camera>& cv::iib::Localizer::cameras() const { return impl_->map.cameras; }

cv::iib::Location cv::iib::Localizer::localize(
        InputArray input, const Camera& camera, const Affine3d* prior) const
{
    const Lens checked(camera);
    const Mat image = input.getMat();
    if (image.size() != camera.size)
        CV_Error(Error::StsBadArg, format("the image has %d x %d pixels and the camera %d x %d", image.cols,
                                           image.rows, camera.size.width, camera.size.height));
    const Features features = extract(*impl_->iib, image);
    Location location;
    location.reason = "too few matches";
    if (!features.pixels.empty() && prior)
        location = impl_->locate(features, camera, impl_->near(*prior), prior);
    if (!features.pixels.empty() && !location.found)
        location = impl_->locate(features, camera, impl_->similar(features.codes), nullptr);
    return location;
}
