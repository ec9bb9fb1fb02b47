// SPDX-License-Identifier: Apache-2.0

#include "localizer.hpp"

#include <algorithm>
#include <limits>

#include "../map/exif_orientation.hpp"
#include "guided_matches.hpp"

namespace cv::iib {
namespace {

constexpr size_t SHORTLIST = 20, CANDIDATES = 5;  // images of the map: by votes, then by matches
constexpr size_t NEAREST = 2;                     // images of the map that are matched for a prior
constexpr double VOTING_SCALES[] = {1, .5, 2};
constexpr double SHARE_CERTAIN = .5;  // of inliers among matches in views: no other image is tried
constexpr int IN_VIEWS = 2000;        // keypoints of an image that is matched in views
constexpr int RANKING = 200;          // strongest codes of an image, which rank the shortlist
constexpr double GATE = .1;           // of the longer side: search radius around a predicted point

//! Mask of keypoints (rows) near the projections of points (columns).
Mat gate(const MapImage& features, const std::vector<Point3d>& points, const Camera& camera,
        const Affine3d& prior)
{
    const double limit = std::round(GATE * std::max(camera.size.width, camera.size.height));
    const std::vector<Point2d> places = Lens(camera).project(inCamera(points, prior));
    Mat mask(int(features.pixels.size()), int(places.size()), CV_8U);
    for (int y = 0; y < mask.rows; y++)
        for (int x = 0; x < mask.cols; x++)
        {
            const Point2d offset = places[size_t(x)] - features.pixels[size_t(y)];
            mask.at<uchar>(y, x) = std::abs(offset.x) < limit && std::abs(offset.y) < limit ? 255 : 0;
        }
    return mask;
}

void checkPoints(int points)
{
    if (points < 0)
        CV_Error(Error::StsBadArg,
                format("points is %d: it must be 0, for as many as the map's images have, or more", points));
}

//! Checks the arguments, then creates the map's extractor.
Ptr<IIB> checkedExtractor(const Map& map, int points, bool lines)
{
    if (lines)
        findSegments(Picture());
    if (lines && map.lines.empty())
        CV_Error(Error::StsError, "the map has no lines: make it with lines, or localize without lines");
    const Ptr<IIB> iib = extractorOf(map.orbAndAkaze, points ? points : map.keypoints);
    for (const MapImage& image : map.images)
        if (image.codes.cols != iib->descriptorSize())
            CV_Error(Error::StsError, "the map's codes are of another version: make the map again");
    return iib;
}

std::vector<Mat> codesOf(const Map& map)
{
    std::vector<Mat> codes;
    for (const MapImage& image : map.images)
        codes.push_back(image.codes);
    return codes;
}

}  // namespace

ImageLocator::ImageLocator(const Map& map, int points, bool lines)
    : map_(map), lines_(lines), iib_(checkedExtractor(map, points, lines)),
      matcher_(HierarchicalMatcher::createRecommended()), votes_(codesOf(map)), pictures_(map.images.size()),
      mapError_(mapError(map))
{
    for (const MapImage& image : map.images)
        depths_.push_back(medianDistance(inCamera(map.seenBy(image), image.cameraFromWorld)));
}

std::vector<size_t> ImageLocator::nearestImages(const Affine3d& pose) const
{
    std::vector<double> distances;
    for (size_t i = 0; i < depths_.size(); i++)
        distances.push_back(depths_[i] > 0 ? distance(pose, map_.images[i].cameraFromWorld, depths_[i])
                                           : std::numeric_limits<double>::infinity());
    return best(depths_.size(), NEAREST, [&](size_t a, size_t b) { return distances[a] < distances[b]; });
}

std::vector<size_t> ImageLocator::similarImages(const Mat& codes) const
{
    const std::vector<float> voted = votes_.vote(codes).ofImages;
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

std::vector<Match> ImageLocator::matchesOf(
        const MapImage& features, const std::vector<size_t>& compared, const Affine3d* prior) const
{
    std::vector<Match> matches;
    for (size_t k : compared)
    {
        const MapImage& image = map_.images[k];
        const std::vector<Point3d> points = map_.seenBy(image);
        std::vector<DMatch> matched;
        if (!points.empty())
            matcher_->match(features.codes, image.codes, matched,
                    prior ? gate(features, points, features.camera, *prior) : Mat());
        for (const DMatch& m : matched)
            matches.push_back({features.pixels[size_t(m.queryIdx)], points[size_t(m.trainIdx)],
                    image.sees[size_t(m.trainIdx)], m.queryIdx, int(m.distance), int(k), m.trainIdx,
                    Vec2f(image.sizes[size_t(m.trainIdx)], features.sizes[size_t(m.queryIdx)])});
    }
    return matches;
}

void ImageLocator::locate(const Affine3d* prior, LocatedImage& found) const
{
    const std::vector<Match> matches = matchesOf(found.features, found.compared, prior);
    found.location.reason = "too few matches";
    found.location.matches = found.location.inliers = 0;
    if (matches.size() >= LEAST_INLIERS)
        findPose(matches, map_, pictures_, found);
}

bool ImageLocator::isMirrored(const Mat& image, const Mat& mask, const LocatedImage& found) const
{
    Mat mirrored, mirroredMask;
    flip(image, mirrored, 1);
    if (!mask.empty())
        flip(mask, mirroredMask, 1);
    MapImage features;
    extract(*iib_, mirrored, mirroredMask, features);
    if (features.pixels.empty())
        return false;
    features.camera = found.features.camera;
    double& centre = features.camera.parameters[focalsOf(features.camera.model)];
    centre = features.camera.size.width - centre;
    const std::vector<Match> matches = matchesOf(features, similarImages(features.codes), nullptr);
    return matches.size() >= LEAST_INLIERS &&
           countInliers(matches, features.camera) > std::max(found.location.inliers, (int)LEAST_INLIERS);
}

std::vector<size_t> ImageLocator::similarImagesInViews(const ImageViews& image) const
{
    std::vector<float> most(map_.images.size());
    for (double scale : VOTING_SCALES)
    {
        std::vector<float> angles;
        for (int degrees = 0; degrees < 360; degrees += 30)
            angles.push_back((float)degrees);
        for (const Described& turned : image.coarse(View::reduced(scale), angles))
        {
            if (turned.codes.empty() || turned.codes.cols != iib_->descriptorSize())
                continue;
            const std::vector<float> voted = votes_.vote(turned.codes).ofImages;
            for (size_t k = 0; k < most.size(); k++)
                most[k] = std::max(most[k], voted[k]);
        }
    }
    return best(most.size(), CANDIDATES, [&](size_t a, size_t b) { return most[a] > most[b]; });
}

void ImageLocator::locateInViews(const Mat& image, const Mat& mask, LocatedImage& found) const
{
    const ImageViews views(image, mask, IN_VIEWS);
    found.compared = similarImagesInViews(views);
    LocatedImage best = found;  // all candidates are tried: repeated patterns match at wrong places too
    for (size_t k : found.compared)
    {
        if (map_.images[k].picture.pixels.empty())
            continue;
        const std::vector<Match> matches = matchesInViews(map_, k, views);
        if (matches.size() < LEAST_INLIERS)
            continue;
        LocatedImage other = found;
        findPose(matches, map_, pictures_, other);
        if (other.location.found && other.location.inliers > best.location.inliers)
            best = other;
        if (best.location.found && best.location.inliers > SHARE_CERTAIN * (double)best.location.matches)
            break;
    }
    if (best.location.found)
        found = best;
}

LocatedImage ImageLocator::find(
        const Photograph& image, const Camera& storedCamera, const Affine3d* storedPrior) const
{
    checkPhotograph(image.pixels, image.mask, storedCamera.size);
    const Lens checked(storedCamera);
    const Upright upright(image.pixels.size(), image.orientation);
    const Affine3d turned = storedPrior ? upright.pose(*storedPrior) : Affine3d();
    const Affine3d* const prior = storedPrior ? &turned : nullptr;
    LocatedImage found;
    extract(*iib_, upright.image(image.pixels), upright.image(image.mask), found.features);
    found.features.camera = upright.camera(storedCamera);
    found.location.reason = "too few matches";
    if (found.features.pixels.empty())
        return found;
    if (lines_)
        found.segments = findSegments(found.features.picture);
    if (prior)
    {
        found.compared = nearestImages(*prior);
        locate(prior, found);
    }
    if (!found.location.found)
    {
        found.compared = similarImages(found.features.codes);
        locate(nullptr, found);
    }
    const bool isClear = found.location.inliers > SHARE_CERTAIN * (double)found.location.matches;
    if (!prior && !(found.location.found && isClear))
    {
        const Mat pixels = upright.image(image.pixels), mask = upright.image(image.mask);
        if (!found.location.found)
            locateInViews(pixels, mask, found);
        if (isMirrored(pixels, mask, found))
        {
            found.location = Location();
            found.location.reason = "the image is mirrored: flip it";
        }
    }
    found.prepared = PreparedPicture();
    Location& location = found.location;
    if (location.found)
        location.covariance += inWorld(mapError_, location.cameraFromWorld, found.depth);
    found.features.cameraFromWorld = location.cameraFromWorld;
    return found;
}

Location asStored(Location location, const Photograph& image)
{
    const Upright upright(image.pixels.size(), image.orientation);
    if (location.found)
        location.cameraFromWorld = upright.storedPose(location.cameraFromWorld);
    for (Point2d& pixel : location.pixels)
        pixel = upright.storedPixel(pixel);
    return location;
}

struct Localizer::Impl
{
    Impl(Map&& read, int points, bool lines)
        : map(std::move(read)), locator(map, points, lines), cameras(camerasOf(map.images))
    {
    }

    const Map map;
    const ImageLocator locator;
    const std::vector<Camera> cameras;
};

Localizer::Localizer(const std::string& map, int points, bool lines)
{
    checkPoints(points);  // before the map is read
    impl_ = std::make_unique<const Impl>(readMap(map), points, lines);
}

Localizer::Localizer(const std::string& model, const ImageReader& images, int points,
        const MappingReport& report, const MapOptions& options)
{
    checkPoints(points);  // before the map is made
    impl_ = std::make_unique<const Impl>(makeMap(model, images, options, report), points, options.lines);
}

Localizer::~Localizer() = default;

const std::vector<Camera>& Localizer::cameras() const { return impl_->cameras; }

Location Localizer::localize(
        InputArray image, const Camera& camera, const Affine3d* prior, int orientation, InputArray mask) const
{
    const Photograph photograph(image.getMat(), orientation, mask.getMat());
    return asStored(impl_->locator.find(photograph, camera, prior).location, photograph);
}

}  // namespace cv::iib
