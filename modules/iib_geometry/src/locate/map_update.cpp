// SPDX-License-Identifier: Apache-2.0

#include <algorithm>
#include <mutex>
#include <set>

#include "localizer.hpp"
#include "../map/map_folder.hpp"
#include "../map/triangulation.hpp"

namespace cv::iib {
namespace {

constexpr double ONE_PLACE = .1;   // largest distance() of two images at one place
constexpr double KNOWN = .5;       // of an image's codes: with more inliers, the map knows this illumination
constexpr size_t MAX_ADDED = 8;    // added images that a map keeps at one place
constexpr uchar MAX_MISSES = 8;    // consecutive updates without a code, after which it is dropped
constexpr size_t NEIGHBOURS = 10;  // added images that each added image is matched with

bool atOnePlace(const LocatedImage& seen, const PosedImage& other)
{
    return distance(seen.location.cameraFromWorld, other.cameraFromWorld, seen.depth) <= ONE_PLACE;
}

//! Counts the misses of each code that this update expected to see. Returns the number of dropped codes.
int countMisses(Map& map, const std::vector<LocatedImage>& all)
{
    std::vector<std::vector<uchar>> expected;
    for (const MapImage& image : map.images)
        expected.emplace_back(image.sees.size());
    std::vector<std::vector<uchar>> hit = expected;
    for (const LocatedImage& seen : all)
    {
        const Rect2d picture(Point2d(-.5, -.5), Size2d(seen.features.camera.size));
        const Lens lens(seen.features.camera);
        for (size_t i : seen.compared)
        {
            const std::vector<Point2d> places =
                    lens.project(inCamera(map.seenBy(map.images[i]), seen.location.cameraFromWorld));
            for (size_t k = 0; k < places.size(); k++)
                expected[i][k] |= picture.contains(places[k]);  // false for NaN, behind the camera
        }
        for (const Match& m : seen.agreeing)
            hit[size_t(m.view)][size_t(m.row)] = 1;
    }
    int dropped = 0;
    for (size_t i = 0; i < map.images.size(); i++)
        for (size_t k = 0; k < hit[i].size(); k++)
        {
            uchar& misses = map.images[i].misses[k];
            if (hit[i][k])
            {
                misses = 0;
                map.images[i].used = map.updates;
            }
            else if (expected[i][k] && ++misses >= MAX_MISSES)
            {
                map.images[i].sees[k] = -1;
                misses = 0;  // the keypoint may get another point
                dropped++;
            }
        }
    return dropped;
}

bool isKnown(const Map& map, const LocatedImage& seen)
{
    std::vector<size_t> hits(map.images.size());
    for (const Match& m : seen.agreeing)
        hits[size_t(m.view)]++;
    for (size_t i = 0; i < hits.size(); i++)
        if (double(hits[i]) > KNOWN * double(map.images[i].sees.size()) && atOnePlace(seen, map.images[i]))
            return true;
    return false;
}

//! The images under illumination that the map does not know, one for each place.
std::vector<const LocatedImage*> imagesToAdd(const Map& map, const std::vector<LocatedImage>& all)
{
    std::vector<const LocatedImage*> result;
    for (const LocatedImage& seen : all)
        if (!isKnown(map, seen) && std::all_of(result.begin(), result.end(), [&](const LocatedImage* other) {
                return !atOnePlace(seen, other->features);
            }))
            result.push_back(&seen);
    return result;
}

/** Pairs of images to match: each added image with the map's images it was compared with, and added images near it.
@param first index of the first added image; added images are the map's last. */
Pairs pairsOf(const Map& map, size_t first, const std::vector<const LocatedImage*>& added)
{
    Pairs pairs;
    for (size_t n = 0; n < added.size(); n++)
    {
        std::vector<std::pair<double, size_t>> near;
        for (size_t other = n + 1; other < added.size(); other++)
            near.emplace_back(distance(map.images[first + n].cameraFromWorld,
                                      map.images[first + other].cameraFromWorld, added[n]->depth),
                    first + other);
        std::sort(near.begin(), near.end());
        for (size_t k : added[n]->compared)
            pairs.emplace_back(first + n, k);
        for (size_t k = 0; k < std::min(near.size(), NEIGHBOURS); k++)
            pairs.emplace_back(first + n, near[k].second);
    }
    return pairs;
}

//! Matches the added images of a map and triangulates their points.
void addPoints(Map& map, const Pairs& pairs)
{
    MatchedRays matched = matchPairs(map.images, pairs);
    std::set<size_t> involved;
    for (const auto& [a, b] : pairs)
        involved.insert({a, b});
    std::set<int> touched;  // points that may get new keypoints
    for (const RayMatch& link : matched.links)
        touched.insert(matched.rays[link.b].point);
    touched.erase(-1);
    for (size_t i = 0; i < map.images.size(); i++)
    {
        const std::vector<int>& sees = map.images[i].sees;
        if (involved.count(i) == 0 &&
                std::any_of(sees.begin(), sees.end(), [&](int p) { return touched.count(p) != 0; }))
            for (const Ray& ray : raysOf(i, map.images[i]))
                if (touched.count(ray.point) != 0)
                    matched.rays.push_back(ray);
    }
    triangulate(map, std::move(matched.rays), std::move(matched.links));
}

//! Keeps the MAX_ADDED most recently used of the added images at one place.
void makeRoom(Map& map, const std::vector<const LocatedImage*>& added)
{
    for (const LocatedImage* seen : added)
    {
        std::vector<std::pair<uint32_t, std::string>> here;
        for (const MapImage& image : map.images)
            if (image.added && atOnePlace(*seen, image))
                here.emplace_back(image.used, image.name);
        std::sort(here.begin(), here.end());
        for (size_t n = 0; n + MAX_ADDED < here.size(); n++)
            map.images.erase(std::find_if(map.images.begin(), map.images.end(),
                    [&](const MapImage& image) { return image.name == here[n].second; }));
    }
}

}  // namespace

struct MapUpdate::Impl
{
    Impl(const std::string& from, const std::string& to)
        : folder(to), map(readMap(from)), locator(map, 0, !map.lines.empty()), cameras(camerasOf(map.images))
    {
    }

    const MapFolder folder;  // first, so that it is locked before the map is read
    const Map map;
    const ImageLocator locator;
    const std::vector<Camera> cameras;
    std::mutex mutex;
    std::set<std::string> names;
    std::vector<LocatedImage> seen;
    bool committed = false;

    void checkOpen() const
    {
        if (committed)
            CV_Error(Error::StsError, "the update was committed already: make another MapUpdate");
    }
};

MapUpdate::MapUpdate(const std::string& map, const std::string& out)
    : impl_(std::make_unique<Impl>(map, out.empty() ? map : out))
{
}

MapUpdate::~MapUpdate() = default;

const std::vector<Camera>& MapUpdate::cameras() const { return impl_->cameras; }

Location MapUpdate::add(
        const std::string& name, InputArray image, const Camera& camera, int orientation, InputArray mask)
{
    const Photograph photograph(image.getMat(), orientation, mask.getMat());
    const auto checkNew = [&] {  // before the work, and again after it
        impl_->checkOpen();
        checkName(name);
        if (impl_->names.count(name) != 0)
            CV_Error(Error::StsBadArg, "an image named '" + name + "' is already a part of the update");
    };
    std::unique_lock<std::mutex> lock(impl_->mutex);
    checkNew();
    lock.unlock();
    LocatedImage found = impl_->locator.find(photograph, camera);
    lock.lock();
    checkNew();
    impl_->names.insert(name);
    found.features.name = name;
    if (found.location.found)
        impl_->seen.push_back(found);
    return asStored(found.location, photograph);
}

MapUpdate::Counts MapUpdate::commit()
{
    const std::lock_guard<std::mutex> lock(impl_->mutex);
    impl_->checkOpen();
    Map map = impl_->map;  // a copy, so that commit() may be called again if writing fails
    std::vector<LocatedImage>& seen = impl_->seen;
    // Sorted, since the result must not depend on the threads' order.
    std::sort(seen.begin(), seen.end(),
            [](const LocatedImage& a, const LocatedImage& b) { return a.features.name < b.features.name; });
    Counts counts;
    counts.localized = int(seen.size());
    map.updates++;
    const std::vector<const LocatedImage*> added = imagesToAdd(map, seen);
    counts.added = int(added.size());
    counts.dropped = countMisses(map, seen);
    const size_t first = map.images.size();
    std::string folder = format("updates/%u/", map.updates);
    const auto taken = [&](const MapImage& image) {
        return image.name.compare(0, folder.size(), folder) == 0;
    };
    while (std::any_of(map.images.begin(), map.images.end(), taken))  // the model may have such names
        folder = "updates/" + folder;
    for (const LocatedImage* s : added)
    {
        MapImage image = s->features;
        image.name = folder + image.name;
        image.used = map.updates;
        image.added = true;
        map.images.push_back(std::move(image));
    }
    addPoints(map, pairsOf(map, first, added));
    makeRoom(map, added);
    map.compact();
    impl_->folder.write(std::move(map));
    impl_->committed = true;
    return counts;
}

}  // namespace cv::iib
