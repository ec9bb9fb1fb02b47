// SPDX-License-Identifier: Apache-2.0

#include "localizer.hpp"

#include <algorithm>
#include <iterator>
#include <limits>
#include <map>
#include <numeric>
#include <set>

#include "mapping.hpp"

namespace cv::iib {
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

//! Keypoints that match a point in several images of the map count once.
std::vector<Match> withoutRepeated(std::vector<Match> matches)
{
    const auto key = [](const Match& m) { return std::make_pair(m.keypoint, m.number); };
    std::stable_sort(
            matches.begin(), matches.end(), [&](const Match& a, const Match& b) { return key(a) < key(b); });
    const auto repeated = [&](const Match& a, const Match& b) { return key(a) == key(b); };
    matches.erase(std::unique(matches.begin(), matches.end(), repeated), matches.end());
    return matches;
}

//! The matches within a limit of where a pose has their points.
std::vector<Match> within(
        double limit, const std::vector<Match>& matches, const Lens& lens, const Affine3d& pose)
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

//! Moves the keypoints of matches to what the map's images show.
void refineMatches(std::vector<Match>& matches, const Map& map, const Features& features)
{
    std::map<int, std::vector<size_t>> byView;
    for (size_t i = 0; i < matches.size(); i++)
        byView[matches[i].view].push_back(i);
    for (const auto& [view, numbers] : byView)
    {
        const MapImage& image = map.images[size_t(view)];
        if (numbers.size() < WORTH || image.picture.pixels.empty())
            continue;
        KeypointPairs pairs;
        for (size_t i : numbers)
        {
            const Match& m = matches[i];
            pairs.fixed.emplace_back(image.pixels[size_t(m.row)], image.sizes[size_t(m.row)]);
            pairs.moved.emplace_back(features.pixels[size_t(m.keypoint)], features.sizes[size_t(m.keypoint)]);
        }
        const std::vector<bool> placed = refine(image.picture, features.picture, pairs);
        for (size_t k = 0; k < numbers.size(); k++)
            if (placed[k])
            {
                matches[numbers[k]].pixel = pairs.moved[k].pt;
                matches[numbers[k]].deviation = REFINED;
            }
    }
}

/** Points of some of a map's images near where a pose has them: where the picture shows what that image does which sees the
point at the most similar size.
@param frame of the pose. */
std::vector<Match> seenAlong(
        const Map& map, const Found& found, const Lens& lens, const Frame& frame, const Affine3d& pose)
{
    const Mat& pixels = found.features.picture.pixels;
    const Rect2d inside(Point2d(), Size2d(pixels.size()) / found.features.picture.scale);
    std::map<int, std::pair<double, Match>> best;  // of a point: logarithm of the ratio of sizes, place
    for (size_t view : found.compared)
    {
        const MapImage& image = map.images[view];
        const double zoom = lens.matrix()(0, 0) / Lens(image.camera).matrix()(0, 0);
        std::vector<Point3d> points = map.seenBy(image);
        const std::vector<Point3d> there = inCamera(points, image.cameraFromWorld);
        for (Point3d& p : points)
            p = frame.toLocal(p);
        const std::vector<Point3d> here = inCamera(points, pose);
        const std::vector<Point2d> places = lens.project(here);
        for (size_t row = 0; row < places.size(); row++)
        {
            const double ratio = std::log(zoom * there[row].z / (here[row].z * frame.unit));
            if (!inside.contains(places[row]) || !(std::abs(ratio) < std::log(MAX_RATIO)))
                continue;
            const int number = image.sees[row];
            const auto known = best.find(number);
            if (known == best.end() || std::abs(ratio) < std::abs(known->second.first))
                best[number] = {ratio, {places[row], points[row], number, -1, 0, int(view), int(row)}};
        }
    }
    std::vector<Match> matches;
    for (size_t view : found.compared)
    {
        const MapImage& image = map.images[view];
        KeypointPairs pairs;
        std::vector<Match> own;
        for (const auto& [number, sight] : best)
            if (sight.second.view == int(view) && !image.picture.pixels.empty())
            {
                own.push_back(sight.second);
                pairs.fixed.emplace_back(image.pixels[size_t(own.back().row)], 1.f);
                pairs.moved.emplace_back(own.back().pixel, float(std::exp(sight.first)));
            }
        if (own.empty())
            continue;
        const std::vector<bool> placed = refine(image.picture, found.features.picture, pairs);
        for (size_t i = 0; i < own.size(); i++)
            if (placed[i])
            {
                own[i].pixel = pairs.moved[i].pt;
                own[i].deviation = REFINED;
                matches.push_back(own[i]);
            }
    }
    return matches;
}

//! Gives the matches that were refined the deviation that they have of where a pose has their points.
void learnDeviation(std::vector<Match>& matches, const Lens& lens, const Affine3d& pose)
{
    const auto refined = [](const Match& m) { return m.deviation != Match().deviation; };
    std::vector<Match> some;
    std::copy_if(matches.begin(), matches.end(), std::back_inserter(some), refined);
    const double deviation = std::max(LEAST_REFINED, deviationOf(errorsOf(some, lens, pose)));
    for (Match& m : matches)
        if (refined(m))
            m.deviation = deviation;
}

//! Finds the pose that matches with points of a map agree on, and whether it is one.
void findPose(std::vector<Match> all, const Map& map, const Camera& camera, Found& found)
{
    const Frame frame(all);
    for (Match& m : all)
        m.point = frame.toLocal(m.point);
    std::vector<Match> matches = withoutRepeated(all);
    found.matches = int(matches.size());
    const Lens lens(camera);
    const double limit = MAX_ERROR * std::max(camera.size.width, camera.size.height);
    std::vector<Match> surest;
    for (size_t i : best(matches.size(), SUREST,
                 [&](size_t a, size_t b) { return matches[a].bits < matches[b].bits; }))
        surest.push_back(matches[i]);
    Affine3d pose;
    Matx66d covariance;
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
            refineMatches(inliers, map, found.features);
            matches = inliers;
        }
    }
    std::vector<Match> used;
    for (int look = 0; look < LOOKS; look++)
    {
        const Affine3d before = pose;
        used = within(limit, matches, lens, pose);
        for (const Match& m : within(limit, seenAlong(map, found, lens, frame, pose), lens, pose))
            used.push_back(m);
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
    Vec3d variances;
    eigen(covariance.get_minor<3, 3>(0, 0), variances);
    found.reason = "the pose is uncertain";
    if (!(3 * std::sqrt(variances[0]) <= MAX_BOUND * medianDistance(inCamera(pointsOf(inliers), pose))))
        return;
    found.found = true;
    found.reason = "";
    found.cameraFromWorld = frame.toWorld(pose);
    found.covariance = frame.toWorld(covariance);
    for (const Match& m : inliers)
        if (m.keypoint >= 0)
        {
            found.pixels.push_back(m.pixel);
            found.points.push_back(map.points[size_t(m.number)]);
        }
    found.agreeing = within(limit, all, lens, pose);
}

//! Which keypoints (rows) may match which points (columns): those near where the prior has them.
Mat gate(const Features& features, const std::vector<Point3d>& points, const Camera& camera,
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

std::vector<Mat> codesOf(const Map& map)
{
    std::vector<Mat> codes;
    for (const MapImage& image : map.images)
        codes.push_back(image.codes);
    return codes;
}

}  // namespace

double medianDistance(const std::vector<Point3d>& points)
{
    std::vector<double> distances;
    for (const Point3d& p : points)
        distances.push_back(norm(p));
    return median(distances);
}

Finder::Finder(const Map& map, int points, bool lines)
    : map_(map), lines_(lines), iib_(describerOf(map.orbAndAkaze, points ? points : map.keypoints)),
      matcher_(HierarchicalMatcher::createRecommended()), votes_(codesOf(map))
{
    if (lines)
        findSegments(Picture());
    if (lines && map.lines.empty())
        CV_Error(Error::StsError, "the map has no lines: make it with lines, or look for none");
    for (const MapImage& image : map.images)
    {
        if (image.codes.cols != iib_->descriptorSize())
            CV_Error(Error::StsError, "the map's codes are not those of this version: make it again");
        depths_.push_back(medianDistance(inCamera(map.seenBy(image), image.cameraFromWorld)));
    }
}

//! The images of the map nearest to a pose.
std::vector<size_t> Finder::near(const Affine3d& pose) const
{
    std::vector<double> distances;
    for (size_t i = 0; i < depths_.size(); i++)
        distances.push_back(depths_[i] > 0 ? distance(pose, map_.images[i].cameraFromWorld, depths_[i])
                                           : std::numeric_limits<double>::infinity());
    return best(depths_.size(), NEAREST, [&](size_t a, size_t b) { return distances[a] < distances[b]; });
}

std::vector<size_t> Finder::similar(const Mat& codes) const
{
    const std::vector<float> voted = votes_.vote(codes);
    std::vector<size_t> counts(voted.size());
    for (size_t k : best(counts.size(), SHORTLIST, [&](size_t a, size_t b) { return voted[a] > voted[b]; }))
        if (voted[k] > 0)
        {
            std::vector<DMatch> found;
            matcher_->match(codes.rowRange(0, std::min(codes.rows, RANKING)), map_.images[k].codes, found);
            counts[k] = found.size();
        }
    std::vector<size_t> order =
            best(counts.size(), CANDIDATES, [&](size_t a, size_t b) { return counts[a] > counts[b]; });
    order.erase(
            std::find_if(order.begin(), order.end(), [&](size_t k) { return counts[k] == 0; }), order.end());
    return order;
}

void Finder::locate(const Camera& camera, const Affine3d* prior, Found& found) const
{
    std::vector<Match> matches;
    for (size_t k : found.compared)
    {
        const MapImage& image = map_.images[k];
        const std::vector<Point3d> points = map_.seenBy(image);
        std::vector<DMatch> matched;
        if (!points.empty())
            matcher_->match(found.features.codes, image.codes, matched,
                    prior ? gate(found.features, points, camera, *prior) : Mat());
        for (const DMatch& m : matched)
            matches.push_back({found.features.pixels[size_t(m.queryIdx)], points[size_t(m.trainIdx)],
                    image.sees[size_t(m.trainIdx)], m.queryIdx, int(m.distance), int(k), m.trainIdx});
    }
    found.reason = "too few matches";
    found.matches = found.inliers = 0;
    if (matches.size() >= LEAST_INLIERS)
        findPose(std::move(matches), map_, camera, found);
}

Found Finder::find(const Mat& image, const Camera& camera, const Affine3d* prior) const
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

struct Localizer::Impl
{
    Impl(Map&& read, int points, bool lines)
        : map(std::move(read)), finder(map, points, lines), cameras(camerasOf(map.images))
    {
    }

    const Map map;
    const Finder finder;
    const std::vector<Camera> cameras;
};

Localizer::Localizer(const std::string& map, int points, bool lines)
    : impl_(std::make_unique<const Impl>(readMap(map), points, lines))
{
}

Localizer::Localizer(const std::string& model, const ImageReader& images, int points,
        const MappingReport& report, const MapOptions& options)
    : impl_(std::make_unique<const Impl>(makeMap(model, images, options, report), points, options.lines))
{
}

Localizer::~Localizer() = default;

const std::vector<Camera>& Localizer::cameras() const { return impl_->cameras; }

Location Localizer::localize(InputArray image, const Camera& camera, const Affine3d* prior) const
{
    return impl_->finder.find(image.getMat(), camera, prior);
}

}  // namespace cv::iib
