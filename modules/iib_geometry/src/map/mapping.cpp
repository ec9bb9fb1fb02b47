// SPDX-License-Identifier: Apache-2.0

#include <algorithm>
#include <limits>
#include <map>
#include <mutex>
#include <set>

#include "../common/parallel.hpp"
#include "../pose/camera_pose.hpp"
#include "features.hpp"
#include "lines.hpp"
#include "map_folder.hpp"
#include "triangulation.hpp"
#include "exif_orientation.hpp"

namespace cv::iib {
namespace {

constexpr size_t NEIGHBOURS = 20;        // images that each image is matched with
constexpr size_t MAX_TRACK = 30;         // images of a point that count as covisible
constexpr double LEAST_CONSISTENT = .1;  // share of matches that fit the poses, if they are of these images

//! The number of points that each image shares with every other.
std::vector<std::map<size_t, int>> countShared(const std::vector<PosedImage>& images)
{
    std::map<int, std::vector<size_t>> seeing;
    for (size_t i = 0; i < images.size(); i++)
        for (int point : images[i].sees)
            if (point >= 0 && seeing[point].size() < MAX_TRACK &&
                    (seeing[point].empty() || seeing[point].back() != i))
                seeing[point].push_back(i);
    std::vector<std::map<size_t, int>> shared(images.size());
    for (const auto& [point, together] : seeing)
        for (size_t a : together)
            for (size_t b : together)
                if (a != b)
                    shared[a][b]++;
    return shared;
}

//! Pairs of covisible images; an image that shares no points is paired with the nearest ones of similar direction.
Pairs covisible(const std::vector<PosedImage>& images)
{
    const std::vector<std::map<size_t, int>> shared = countShared(images);
    std::set<std::pair<size_t, size_t>> pairs;
    for (size_t i = 0; i < images.size(); i++)
    {
        std::vector<std::pair<double, size_t>> others;
        for (const auto& [other, count] : shared[i])
            others.emplace_back(-count, other);
        for (size_t other = 0; shared[i].empty() && other < images.size(); other++)
        {
            const Affine3d turn = images[i].cameraFromWorld * inverse(images[other].cameraFromWorld);
            if (other != i && turn.rotation()(2, 2) > .5)
                others.emplace_back(norm(turn.translation()), other);
        }
        std::sort(others.begin(), others.end());
        for (size_t n = 0; n < std::min(others.size(), NEIGHBOURS); n++)
            pairs.insert(std::minmax(i, others[n].second));
    }
    return {pairs.begin(), pairs.end()};
}

//! Why an image is left out, to follow its name; empty if it is not.
std::string problemOf(const Photograph& photograph, const Size& size)
{
    if (photograph.pixels.empty())
        return " cannot be read";
    try
    {
        checkPhotograph(photograph.pixels, photograph.mask, size);
        const Upright checked(size, photograph.orientation);
    }
    catch (const Exception& e)
    {
        return ": " + e.err;
    }
    return "";
}

Vec3d axisOf(const Affine3d& cameraFromWorld, int axis)
{
    return Vec3d(cameraFromWorld.rotation().row(axis).t().val);
}

/** The world direction that is up in most images and roughly parallel to every image plane. Described relative to it,
images match whether the camera was held upright or looks down. */
Vec3d commonUp(const std::vector<MapImage>& images)
{
    const double agreement = .1;  // weight of being up, against being parallel to the image plane
    Vec3d best;
    double most = -std::numeric_limits<double>::max();
    for (const MapImage& candidate : images)
    {
        const Vec3d up = -axisOf(candidate.cameraFromWorld, 1);
        double score = 0;
        for (const MapImage& image : images)
            score += 1 - std::pow(up.dot(axisOf(image.cameraFromWorld, 2)), 2) -
                     agreement * up.dot(axisOf(image.cameraFromWorld, 1));
        if (score > most)
        {
            most = score;
            best = up;
        }
    }
    return best;
}

//! Degrees by which an image is rotated against a world direction; -1 where upright keypoints match as well.
float angleTo(const Vec3d& up, const Affine3d& cameraFromWorld)
{
    const float least = 15;
    const Vec3d seen = cameraFromWorld.rotation() * up;
    const float angle = fastAtan2((float)seen[0], (float)-seen[1]);
    return std::min(angle, 360 - angle) < least ? -1 : angle;
}

//! @param step called after each image, by several threads, with the problem of an image that is left out.
void describeImages(std::vector<MapImage>& images, const ImageReader& read, const MapOptions& options,
        const std::function<void(const std::string&)>& step)
{
    const Ptr<IIB> iib = extractorOf(options.orbAndAkaze, options.points);
    const Vec3d up = commonUp(images);
    std::vector<std::string> problems(images.size());
    inParallel(images.size(), [&](size_t i) {
        MapImage& image = images[i];
        const Photograph photograph = read(image.name);
        std::string& problem = problems[i] = problemOf(photograph, image.camera.size);
        if (problem.empty())
        {
            const Upright upright(photograph.pixels.size(), photograph.orientation);
            image.camera = upright.camera(image.camera);
            image.cameraFromWorld = upright.pose(image.cameraFromWorld);
            extract(*iib, upright.image(photograph.pixels), upright.image(photograph.mask), image,
                    options.maxSize, angleTo(up, image.cameraFromWorld));
        }
        image.codes.create(int(image.pixels.size()), iib->descriptorSize(), CV_8U);  // also without keypoints
        if (!problem.empty())
            problem = image.name + problem + ": left out of the map";
        step(problem);
    });
    if (std::any_of(images.begin(), images.end(), [](const MapImage& i) { return !i.pixels.empty(); }))
        return;
    const auto first =
            std::find_if(problems.begin(), problems.end(), [](const std::string& p) { return !p.empty(); });
    CV_Error(Error::StsError,
            "no keypoint was found in any of the model's images: " +
                    (first == problems.end() ? "they show nothing"
                                             : "give the images that it was made of; " + *first));
}

void checkOptions(const MapOptions& options)
{
    if (options.points < 1)
        CV_Error(Error::StsBadArg, format("points is %d: it must be at least 1", options.points));
    if (options.maxSize != 0 && options.maxSize < 32)
        CV_Error(Error::StsBadArg,
                format("maxSize is %d: it must be 0 or at least 32 pixels", options.maxSize));
    if (options.lines)
        findSegments(Picture());
}

}  // namespace

Map makeMap(const std::string& model, const ImageReader& read, const MapOptions& options,
        const MappingReport& report)
{
    checkOptions(options);
    std::vector<PosedImage> known = readModel(model);
    const Pairs pairs = covisible(known);
    std::mutex mutex;
    size_t done = 0;
    const auto step = [&](const std::string& problem) {
        const std::lock_guard<std::mutex> lock(mutex);
        done++;
        if (report)
            report(done, known.size() + pairs.size(), problem);
    };
    Map map;
    map.keypoints = options.points;
    map.orbAndAkaze = options.orbAndAkaze;
    for (PosedImage& image : known)
    {
        image.pixels = {};  // found anew; this frees the model's
        image.sees = {};
        map.images.emplace_back();
        static_cast<PosedImage&>(map.images.back()) = image;
    }
    describeImages(map.images, read, options, step);
    MatchedRays matched = matchPairs(map.images, pairs, [&] { step(""); });
    if (double(matched.consistent) <= LEAST_CONSISTENT * double(matched.matches))
        CV_Error(Error::StsError,
                format("only %d of %d matches fit the poses: is this the model of these images?",
                        int(matched.consistent), int(matched.matches)));
    triangulate(map, std::move(matched.rays), std::move(matched.links));
    if (map.points.empty())
        CV_Error(Error::StsError, model + ": no point was seen from two places");
    map.compact();
    if (options.lines)
    {
        std::vector<Segments> segments(map.images.size());
        inParallel(segments.size(), [&](size_t i) { segments[i] = findSegments(map.images[i].picture); });
        addLines(map, segments, pairs);
    }
    return map;
}

void buildMap(const std::string& model, const ImageReader& images, const std::string& map,
        const MapOptions& options, const MappingReport& report)
{
    checkOptions(options);
    const MapFolder folder(map);
    folder.write(makeMap(model, images, options, report));
}

}  // namespace cv::iib
