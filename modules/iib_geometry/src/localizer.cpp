// SPDX-License-Identifier: Apache-2.0

#include "localizer.hpp"

#include <algorithm>
#include <iterator>
#include <limits>
#include <map>
#include <numeric>
#include <set>

#include "mapping.hpp"
#include "numbers.hpp"

namespace iib_localization {
namespace {

constexpr size_t SHORTLIST = 20, CANDIDATES = 5;  // of the map's images: by votes, and of these by matches
constexpr size_t NEAREST = 2;                     // of the map's images, to a prior
constexpr int RANKING = 200;    // strongest codes of an image, whose matches rank the shortlist
constexpr size_t SUREST = 300;  // matches of the fewest different bits, among which the pose is looked for
constexpr double GATE = .1;  // of the longer side: how far from where a prior has them points are looked for
constexpr double MAX_ERROR =
        .006;  // of the longer side: an inlier's distance from where the pose has its point
constexpr double LEAST_INLIERS = 15, LEAST_SHARE = .02;  // in an unknown place a few matches agree by chance
constexpr double MAX_BOUND = .1;  // of the distance to the points: three standard deviations of the place
// Pixels: deviation of a keypoint that refineMatches placed, with that of its point, before it is learned and at least.
constexpr double REFINED = .3, LEAST_REFINED = .03;
constexpr int LOOKS = 8;         // at most, along the pose
constexpr double STILL = .1;     // pixels that what is seen moves by a look, if it is the last one
constexpr double AGAIN = .25;    // pixels from where a point was looked for, at which it is once more
constexpr double MAX_RATIO = 3;  // of the sizes at which two images see a point
constexpr int LINE_ROUNDS = 2;   // lines are looked for again after the first refinement by them
constexpr size_t WORTH = 16;     // matches with an image of the map, for which they are refined

//! What sorts first, of so many.
template <typename Before> std::vector<size_t> best(size_t all, size_t count, Before before)
{
    std::vector<size_t> order(all);
    std::iota(order.begin(), order.end(), size_t(0));
    std::stable_sort(order.begin(), order.end(), before);
    order.resize(std::min(all, count));
    return order;
}

//! The first match of each key, in the keys' order.
template <typename Key> std::vector<Match> firstOfEach(std::vector<Match> matches, Key key)
{
    std::stable_sort(
            matches.begin(), matches.end(), [&](const Match& a, const Match& b) { return key(a) < key(b); });
    const auto repeated = [&](const Match& a, const Match& b) { return key(a) == key(b); };
    matches.erase(std::unique(matches.begin(), matches.end(), repeated), matches.end());
    return matches;
}

//! The matches within a limit of where a pose has their points.
std::vector<Match> within(
        double limit, const std::vector<Match>& matches, const Lens& lens, const cv::Affine3d& pose)
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

/** Moves matches to what the map's images show, where WORTH of them share one.
@param some indices of matches, by the image of the map.
@param start of such an index: where it is looked for, its size in units of that in the map's image. */
template <typename Start>
void refineMatches(std::vector<Match>& matches, const std::map<int, std::vector<size_t>>& some,
        const Map& map, const Picture& picture, Start start)
{
    for (const auto& [view, numbers] : some)
    {
        const MapImage& image = map.images[size_t(view)];
        if (numbers.size() < WORTH || image.picture.pixels.empty())
            continue;
        KeypointPairs pairs;
        for (size_t i : numbers)
        {
            pairs.fixed.emplace_back(image.pixels[size_t(matches[i].row)], 1.f);
            pairs.moved.push_back(start(i));
        }
        const std::vector<bool> placed = refine(image.picture, picture, pairs);
        for (size_t k = 0; k < numbers.size(); k++)
        {
            matches[numbers[k]].pixel = pairs.moved[k].pt;
            matches[numbers[k]].deviation = placed[k] ? REFINED : Match().deviation;
        }
    }
}

bool isRefined(const Match& match) { return match.deviation != Match().deviation; }

/** What some of a map's images see, looked for in another one where a pose has it: each point by the image that sees it at the most
similar size. */
class Sights
{
public:
    //! @param frame of the poses. @param pose about that which look() is called with.
    Sights(const Map& map, const Found& found, const Lens& lens, const Frame& frame, const cv::Affine3d& pose)
        : map_(map), picture_(found.features.picture), lens_(lens)
    {
        struct Sight
        {
            double ratio, depth;
            Match match;
        };
        std::map<int, Sight> best;  // of each point
        for (size_t view : found.compared)
        {
            const MapImage& image = map.images[view];
            const double zoom = lens.matrix()(0, 0) / Lens(image.camera).matrix()(0, 0);
            const std::vector<cv::Point3d> points = map.seenBy(image),
                                           there = inCamera(points, image.cameraFromWorld);
            for (size_t row = 0; row < points.size(); row++)
            {
                const cv::Point3d point = frame.toLocal(points[row]);
                const double depth = zoom * there[row].z / frame.unit;
                const double ratio = std::abs(std::log(depth / (pose * point).z));
                const int number = image.sees[row];
                const auto known = best.find(number);
                if (ratio < std::log(MAX_RATIO) && (known == best.end() || ratio < known->second.ratio))
                    best[number] = {ratio, depth, {{}, point, number, -1, 0, int(view), int(row)}};
            }
        }
        for (const auto& [number, sight] : best)
        {
            matches_.push_back(sight.match);
            depths_.push_back(sight.depth);
        }
        starts_.assign(matches_.size(), {HUGE_VAL, HUGE_VAL});
    }

    //! Points and where they are found; they are looked for where the pose has them, unless that has been done near there.
    std::vector<Match> look(const cv::Affine3d& pose)
    {
        const cv::Rect2d inside(cv::Point2d(), cv::Size2d(picture_.pixels.size()) / picture_.scale);
        const std::vector<cv::Point3d> here = inCamera(pointsOf(matches_), pose);
        const std::vector<cv::Point2d> places = lens_.project(here);
        std::map<int, std::vector<size_t>> moved;
        for (size_t i = 0; i < places.size(); i++)
            if (inside.contains(places[i]) && cv::norm(places[i] - starts_[i]) >= AGAIN)
                moved[matches_[i].view].push_back(i);
        refineMatches(matches_, moved, map_, picture_, [&](size_t i) {
            starts_[i] = places[i];
            return cv::KeyPoint(places[i], float(depths_[i] / here[i].z));
        });
        std::vector<Match> found;
        std::copy_if(matches_.begin(), matches_.end(), std::back_inserter(found), isRefined);
        return found;
    }

private:
    const Map& map_;
    const Picture& picture_;
    const Lens& lens_;
    std::vector<Match> matches_;
    std::vector<double> depths_;       //!< in the other image, at which both see the point at one size
    std::vector<cv::Point2d> starts_;  //!< where they were looked for the last time
};

//! Gives the matches that were refined the deviation that they have of where a pose has their points.
void learnDeviation(std::vector<Match>& matches, const Lens& lens, const cv::Affine3d& pose)
{
    std::vector<Match> refined;
    std::copy_if(matches.begin(), matches.end(), std::back_inserter(refined), isRefined);
    const double deviation = std::max(LEAST_REFINED, deviationOf(errorsOf(refined, lens, pose)));
    for (Match& m : matches)
        if (isRefined(m))
            m.deviation = deviation;
}

//! Finds the pose that matches with points of a map agree on, and whether it is one.
void findPose(std::vector<Match> all, const Map& map, const Camera& camera, Found& found)
{
    const Frame frame(all);
    for (Match& m : all)
        m.point = frame.toLocal(m.point);
    // Keypoints that match a point in several images of the map count once.
    std::vector<Match> matches =
            firstOfEach(all, [](const Match& m) { return std::make_pair(m.keypoint, m.number); });
    found.matches = int(matches.size());
    const Lens lens(camera);
    const double limit = MAX_ERROR * std::max(camera.size.width, camera.size.height);
    std::vector<Match> surest;
    for (size_t i : best(matches.size(), SUREST,
                 [&](size_t a, size_t b) { return matches[a].bits < matches[b].bits; }))
        surest.push_back(matches[i]);
    cv::Affine3d pose;
    cv::Matx66d covariance;
    found.reason = "too few matches agree";
    if (!poseByRansac(surest, lens, limit, pose))
        return;
    std::vector<Match> inliers;
    for (int round = 0; round < 4; round++)  // what agrees is looked for again after each refinement
    {
        if (round > 0 && !refinePose(inliers, lens, pose, covariance))
        {
            found.reason = "the points do not determine the pose";
            return;
        }
        inliers = within(limit, matches, lens, pose);
        found.inliers = keypointsOf(inliers);
        if (found.inliers < LEAST_INLIERS + LEAST_SHARE * double(found.matches))
            return;
        if (round == 1)
        {
            std::map<int, std::vector<size_t>> byView;
            for (size_t i = 0; i < inliers.size(); i++)
                byView[inliers[i].view].push_back(i);
            refineMatches(inliers, byView, map, found.features.picture, [&](size_t i) {
                const Match& m = inliers[i];
                const float size = map.images[size_t(m.view)].sizes[size_t(m.row)];
                return cv::KeyPoint(m.pixel, found.features.sizes[size_t(m.keypoint)] / size);
            });
            matches = inliers;
        }
    }
    Sights sights(map, found, lens, frame, pose);
    std::vector<Match> used;
    for (int look = 0; look < LOOKS; look++)
    {
        const cv::Affine3d before = pose;
        used = within(limit, sights.look(pose), lens, pose);
        for (const Match& m : within(limit, matches, lens, pose))
            used.push_back(m);
        used = firstOfEach(used, [](const Match& m) { return m.number; });  // an image sees a point once
        learnDeviation(used, lens, pose);
        if (!refinePose(used, lens, pose, covariance))
            return;
        inliers = within(limit, used, lens, pose);
        const double depth = medianDistance(inCamera(pointsOf(inliers), pose));
        if (lens.matrix()(0, 0) * distance(pose, before, depth) < STILL)
            break;
    }
    for (int round = 0; round < LINE_ROUNDS && !found.segments.places.empty(); round++)
    {
        used = inliers;
        for (const Match& m : lineMatches(map, found.compared, found.segments, lens, frame, pose, limit))
            used.push_back(m);
        if (!refinePose(used, lens, pose, covariance))
            return;
        inliers = within(limit, inliers, lens, pose);
    }
    covariance = clusteredCovariance(covariance, used, lens, pose);
    cv::Vec3d variances;
    cv::eigen(covariance.get_minor<3, 3>(0, 0), variances);
    found.reason = "the pose is uncertain";
    if (!(3 * std::sqrt(variances[0]) <= MAX_BOUND * medianDistance(inCamera(pointsOf(inliers), pose))))
        return;
    found.found = true;
    found.reason = "";
    found.cameraFromWorld = frame.toWorld(pose);
    found.covariance = frame.toWorld(covariance);
    inliers = within(limit, matches, lens, pose);
    found.inliers = keypointsOf(inliers);
    for (const Match& m : inliers)
    {
        found.pixels.push_back(m.pixel);
        found.points.push_back(map.points[size_t(m.number)]);
    }
    found.agreeing = within(limit, all, lens, pose);
}

//! Which keypoints (rows) may match which points (columns): those near where the prior has them.
cv::Mat gate(const Features& features, const std::vector<cv::Point3d>& points, const Camera& camera,
        const cv::Affine3d& prior)
{
    const double limit = std::round(GATE * std::max(camera.size.width, camera.size.height));
    const std::vector<cv::Point2d> places = Lens(camera).project(inCamera(points, prior));
    cv::Mat mask(int(features.pixels.size()), int(places.size()), CV_8U);
    for (int y = 0; y < mask.rows; y++)
        for (int x = 0; x < mask.cols; x++)
        {
            const cv::Point2d way = places[size_t(x)] - features.pixels[size_t(y)];
            mask.at<uchar>(y, x) = std::abs(way.x) < limit && std::abs(way.y) < limit ? 255 : 0;
        }
    return mask;
}

std::vector<cv::Mat> codesOf(const Map& map)
{
    std::vector<cv::Mat> codes;
    for (const MapImage& image : map.images)
        codes.push_back(image.codes);
    return codes;
}

}  // namespace

double medianDistance(const std::vector<cv::Point3d>& points)
{
    std::vector<double> distances;
    for (const cv::Point3d& p : points)
        distances.push_back(cv::norm(p));
    return median(distances);
}

Finder::Finder(const Map& map, int points, bool lines)
    : map_(map), lines_(lines), iib_(describerOf(map.orbAndAkaze, points ? points : map.keypoints)),
      matcher_(cv::iib::HierarchicalMatcher::createRecommended()), votes_(codesOf(map))
{
    if (lines)
        findSegments(Picture());
    if (lines && map.lines.empty())
        CV_Error(cv::Error::StsError, "the map has no lines: make it with lines, or look for none");
    for (const MapImage& image : map.images)
    {
        if (image.codes.cols != iib_->descriptorSize())
            CV_Error(cv::Error::StsError, "the map's codes are not those of this version: make it again");
        depths_.push_back(medianDistance(inCamera(map.seenBy(image), image.cameraFromWorld)));
    }
}

//! The images of the map nearest to a pose.
std::vector<size_t> Finder::near(const cv::Affine3d& pose) const
{
    std::vector<double> distances;
    for (size_t i = 0; i < depths_.size(); i++)
        distances.push_back(depths_[i] > 0 ? distance(pose, map_.images[i].cameraFromWorld, depths_[i])
                                           : std::numeric_limits<double>::infinity());
    return best(depths_.size(), NEAREST, [&](size_t a, size_t b) { return distances[a] < distances[b]; });
}

std::vector<size_t> Finder::similar(const cv::Mat& codes) const
{
    const std::vector<float> voted = votes_.vote(codes);
    std::vector<size_t> counts(voted.size());
    for (size_t k : best(counts.size(), SHORTLIST, [&](size_t a, size_t b) { return voted[a] > voted[b]; }))
        if (voted[k] > 0)
        {
            std::vector<cv::DMatch> found;
            matcher_->match(codes.rowRange(0, std::min(codes.rows, RANKING)), map_.images[k].codes, found);
            counts[k] = found.size();
        }
    std::vector<size_t> order =
            best(counts.size(), CANDIDATES, [&](size_t a, size_t b) { return counts[a] > counts[b]; });
    order.erase(
            std::find_if(order.begin(), order.end(), [&](size_t k) { return counts[k] == 0; }), order.end());
    return order;
}

void Finder::locate(const Camera& camera, const cv::Affine3d* prior, Found& found) const
{
    std::vector<Match> matches;
    for (size_t k : found.compared)
    {
        const MapImage& image = map_.images[k];
        const std::vector<cv::Point3d> points = map_.seenBy(image);
        std::vector<cv::DMatch> matched;
        if (!points.empty())
            matcher_->match(found.features.codes, image.codes, matched,
                    prior ? gate(found.features, points, camera, *prior) : cv::Mat());
        for (const cv::DMatch& m : matched)
            matches.push_back({found.features.pixels[size_t(m.queryIdx)], points[size_t(m.trainIdx)],
                    image.sees[size_t(m.trainIdx)], m.queryIdx, int(m.distance), int(k), m.trainIdx});
    }
    found.reason = "too few matches";
    found.matches = found.inliers = 0;
    if (matches.size() >= LEAST_INLIERS)
        findPose(std::move(matches), map_, camera, found);
}

Found Finder::find(const cv::Mat& image, const Camera& camera, const cv::Affine3d* prior) const
{
    checkImage(image, camera.size);
    const Lens checked(camera);
    Found found;
    found.features = extract(*iib_, image);
    found.reason = "too few matches";
    if (found.features.pixels.empty())
        return found;
    if (lines_)
        found.segments = findSegments(found.features.picture);
    if (prior)
    {
        found.compared = near(*prior);
        locate(camera, prior, found);
    }
    if (!found.found)
    {
        found.compared = similar(found.features.codes);
        locate(camera, nullptr, found);
    }
    return found;
}

}  // namespace iib_localization

using namespace iib_localization;

struct cv::iib::Localizer::Impl
{
    Impl(Map&& read, int points, bool lines)
        : map(std::move(read)), finder(map, points, lines), cameras(camerasOf(map.images))
    {
    }

    const Map map;
    const Finder finder;
    const std::vector<Camera> cameras;
};

cv::iib::Localizer::Localizer(const std::string& map, int points, bool lines)
    : impl_(std::make_unique<const Impl>(readMap(map), points, lines))
{
}

cv::iib::Localizer::Localizer(const std::string& model, const ImageReader& images, int points,
        const MappingReport& report, const MapOptions& options)
    : impl_(std::make_unique<const Impl>(makeMap(model, images, options, report), points, options.lines))
{
}

cv::iib::Localizer::~Localizer() = default;

const std::vector<cv::iib::Camera>& cv::iib::Localizer::cameras() const { return impl_->cameras; }

cv::iib::Location cv::iib::Localizer::localize(
        InputArray image, const Camera& camera, const Affine3d* prior) const
{
    return impl_->finder.find(image.getMat(), camera, prior);
}
