// SPDX-License-Identifier: Apache-2.0

#include "mapping.hpp"

#include <algorithm>
#include <filesystem>
#include <mutex>
#include <numeric>
#include <set>

#include "colmap_model.hpp"
#include "features.hpp"
#include "lens.hpp"
#include "numbers.hpp"
#include "opencv2/imgcodecs.hpp"

// The steps and numbers are those of Python's opencv_iib.localization.
namespace iib_localization {
namespace {

using cv::iib::Localizer;

constexpr size_t NEIGHBOURS = 20;  // images that each is matched with
constexpr double MAX_ERROR = 4;  // pixels, of a match from its epipolar line and of a keypoint from its point
constexpr double FAR = .01;      // radians between rays that do not tell on which side they meet
constexpr double MIN_ANGLE = 1.5;     // degrees between the rays of a point
constexpr double LEAST_FITTING = .1;  // of all matches; poses that contradict the images leave less
constexpr int ROUNDS = 5;             // of a point's refinement

//! A keypoint of an image, and where it is seen from and to in the world.
struct Ray
{
    size_t image;
    int keypoint;
    cv::Vec3d centre, direction;
    double scale;  // pixels a radian

    //! Pixels from where the keypoint's point would be seen.
    double error(const cv::Vec3d& point) const
    {
        const cv::Vec3d way = point - centre;
        return scale * std::atan2(cv::norm(way.cross(direction)), way.dot(direction));
    }
};

double angleOf(const Ray& a, const Ray& b)
{
    return std::atan2(cv::norm(a.direction.cross(b.direction)), a.direction.dot(b.direction));
}

//! Whether two rays lie in one plane with both cameras, and meet before them.
bool fitting(const Ray& a, const Ray& b)
{
    const cv::Vec3d way = b.centre - a.centre, across = a.direction.cross(b.direction);
    const cv::Vec3d planeA = way.cross(b.direction), planeB = way.cross(a.direction);
    const double product = std::abs(a.direction.dot(planeA));
    return a.scale * product < MAX_ERROR * cv::norm(planeA) &&
           b.scale * product < MAX_ERROR * cv::norm(planeB) &&
           (cv::norm(across) < FAR || (across.dot(planeA) > 0 && across.dot(planeB) > 0));
}

//! The point nearest to rays by angle, with Cauchy's loss of a pixel.
cv::Vec3d meetingPoint(const std::vector<Ray>& track)
{
    cv::Vec3d point;
    std::vector<double> weights(track.size(), 1);
    for (int round = 0; round < ROUNDS; round++)
    {
        cv::Matx33d normal = cv::Matx33d::zeros();
        cv::Vec3d sum;
        for (size_t i = 0; i < track.size(); i++)
        {
            const cv::Vec3d& along = track[i].direction;
            const cv::Matx33d across = weights[i] * (cv::Matx33d::eye() - along * along.t());
            normal += across;
            sum += across * track[i].centre;
        }
        point = normal.solve(sum, cv::DECOMP_LU);
        for (size_t i = 0; i < track.size(); i++)
        {
            const cv::Vec3d way = point - track[i].centre;
            const double error = track[i].error(point);
            weights[i] = 1 / (way.dot(way) * (1 + error * error));
        }
    }
    return point;
}

/** The point of a track; the keypoints farthest from it are left out until the others agree.
@return false if too few agree, or look from nearly the same direction. */
bool place(std::vector<Ray>& track, cv::Vec3d& point)
{
    for (; track.size() > 1;)
    {
        point = meetingPoint(track);
        const auto worst = std::max_element(track.begin(), track.end(),
                [&](const Ray& a, const Ray& b) { return a.error(point) < b.error(point); });
        if (worst->error(point) < MAX_ERROR)
            break;
        track.erase(worst);
    }
    double widest = 0;
    for (const Ray& a : track)
        for (const Ray& b : track)
            widest = std::max(widest, angleOf(a, b));
    return widest * 180 / CV_PI >= MIN_ANGLE;
}

//! Pairs of images that see the same; an image that shares no points is paired with the nearest that look the same way.
std::set<std::pair<size_t, size_t>> covisible(const std::vector<ModelImage>& images)
{
    std::set<std::pair<size_t, size_t>> pairs;
    for (size_t i = 0; i < images.size(); i++)
    {
        std::vector<std::pair<double, size_t>> others;
        for (const auto& [other, count] : images[i].shared)
            if (count > 0)
                others.emplace_back(-count, other);
        for (size_t other = 0; images[i].shared.empty() && other < images.size(); other++)
        {
            const cv::Affine3d turn = images[i].cameraFromWorld * images[other].cameraFromWorld.inv();
            if (other != i && turn.rotation()(2, 2) > .5)
                others.emplace_back(cv::norm(turn.translation()), other);
        }
        std::sort(others.begin(), others.end());
        for (size_t n = 0; n < std::min(others.size(), NEIGHBOURS); n++)
            pairs.insert(std::minmax(i, others[n].second));
    }
    return pairs;
}

//! Counts the steps of several threads.
class Steps
{
public:
    Steps(size_t all, const Localizer::Report& report) : all_(all), report_(report) {}

    void step()
    {
        const std::lock_guard<std::mutex> lock(mutex_);
        done_++;
        tell("");
    }

    //! Of a photograph that is left out.
    void tell(const std::string& problem) const
    {
        if (report_)
            report_(done_, all_, problem);
    }

private:
    const size_t all_;
    const Localizer::Report& report_;
    size_t done_ = 0;
    std::mutex mutex_;
};

//! Calls an action with each index, several at once.
template <typename Action> void inParallel(size_t count, Action action)
{
    cv::parallel_for_(cv::Range(0, int(count)), [&](const cv::Range& range) {
        for (int i = range.start; i < range.end; i++)
            action(size_t(i));
    });
}

std::vector<Features> describe(
        const std::vector<ModelImage>& images, const std::string& folder, int points, Steps& steps)
{
    std::vector<Features> features(images.size());
    std::vector<std::string> problems(images.size());
    const cv::Ptr<cv::iib::IIB> iib = cv::iib::IIB::createRecommended(points);
    inParallel(images.size(), [&](size_t i) {
        const std::string path = folder + "/" + images[i].name;
        std::error_code error;
        cv::Mat image;
        if (std::filesystem::is_regular_file(path, error))
            image = cv::imread(path, cv::IMREAD_GRAYSCALE | cv::IMREAD_IGNORE_ORIENTATION);
        const cv::Size size = images[i].camera.size;
        if (!image.empty() && image.size() != size)
            CV_Error(cv::Error::StsError,
                    cv::format(
                            "%s has %d x %d pixels and its camera in the model %d x %d: give the images of "
                            "which the model was made",
                            path.c_str(), image.cols, image.rows, size.width, size.height));
        features[i] = extract(*iib, image);
        if (image.empty())
            problems[i] = path + " cannot be read: left out of the map";
        steps.step();
    });
    if (std::count(problems.begin(), problems.end(), "") == 0)
        CV_Error(cv::Error::StsError, "none of the model's images can be read below " + folder);
    for (const std::string& problem : problems)
        if (!problem.empty())
            steps.tell(problem);
    return features;
}

//! Two keypoints, of all images' in a row, that match.
struct Link
{
    float bits;
    size_t a, b;
};

//! The surest matches first join keypoints to tracks, which hold one of an image at most.
std::vector<std::vector<Ray>> join(const std::vector<Ray>& rays, std::vector<Link> links)
{
    std::stable_sort(
            links.begin(), links.end(), [](const Link& a, const Link& b) { return a.bits < b.bits; });
    std::vector<size_t> trackOf(rays.size());
    std::iota(trackOf.begin(), trackOf.end(), size_t(0));
    std::vector<std::vector<size_t>> tracks;
    for (size_t k : trackOf)
        tracks.push_back({k});
    for (const Link& link : links)
    {
        std::vector<size_t>&into = tracks[trackOf[link.a]], &from = tracks[trackOf[link.b]];
        const auto clashes = [&](size_t k) {
            return std::any_of(
                    into.begin(), into.end(), [&](size_t o) { return rays[o].image == rays[k].image; });
        };
        if (std::any_of(from.begin(), from.end(), clashes))  // also if they are one already
            continue;
        for (size_t k : from)
            trackOf[k] = trackOf[link.a];
        into.insert(into.end(), from.begin(), from.end());
        from.clear();
    }
    std::vector<std::vector<Ray>> joined;
    for (const std::vector<size_t>& track : tracks)
        if (track.size() > 1)
        {
            joined.emplace_back();
            for (size_t k : track)
                joined.back().push_back(rays[k]);
        }
    return joined;
}

}  // namespace

Map buildMap(const std::string& folder, const std::string& photographs, const Localizer::Report& report)
{
    const std::vector<ModelImage> images = readModel(folder);
    const std::set<std::pair<size_t, size_t>> chosen = covisible(images);
    const std::vector<std::pair<size_t, size_t>> pairs(chosen.begin(), chosen.end());
    Steps steps(images.size() + pairs.size(), report);
    Map map;
    const std::vector<Features> features = describe(images, photographs, map.keypoints, steps);

    std::vector<Ray> rays;
    std::vector<size_t> first;  // of each image
    for (size_t i = 0; i < images.size(); i++)
    {
        const Lens lens(images[i].camera);
        const cv::Affine3d pose = images[i].cameraFromWorld.inv();
        const cv::Matx33d toWorld = pose.rotation() * lens.matrix().inv();
        first.push_back(rays.size());
        for (const cv::Point2d& p : lens.undistorted(features[i].pixels))
            rays.push_back({i, int(rays.size() - first[i]), pose.translation(),
                    cv::normalize(toWorld * cv::Vec3d(p.x, p.y, 1)), lens.matrix()(0, 0)});
    }

    std::vector<Link> links;
    size_t all = 0;
    const cv::Ptr<cv::iib::HierarchicalMatcher> matcher = cv::iib::HierarchicalMatcher::createRecommended();
    std::vector<std::vector<cv::DMatch>> matches(pairs.size());
    inParallel(pairs.size(), [&](size_t n) {
        const auto [a, b] = pairs[n];
        if (!features[a].codes.empty() && !features[b].codes.empty())
            matcher->match(features[a].codes, features[b].codes, matches[n]);
        steps.step();
    });
    for (size_t n = 0; n < pairs.size(); n++)
        for (const cv::DMatch& m : matches[n])
        {
            const size_t a = first[pairs[n].first] + size_t(m.queryIdx),
                         b = first[pairs[n].second] + size_t(m.trainIdx);
            all++;
            if (fitting(rays[a], rays[b]))
                links.push_back({m.distance, a, b});
        }
    if (double(links.size()) <= LEAST_FITTING * double(all))
        CV_Error(cv::Error::StsError,
                cv::format("only %d of %d matches fit the poses: is this the model of these images?",
                        int(links.size()), int(all)));

    std::vector<std::vector<int>> sees(images.size());
    for (size_t i = 0; i < images.size(); i++)
        sees[i].assign(features[i].pixels.size(), -1);
    for (std::vector<Ray>& track : join(rays, std::move(links)))
    {
        cv::Vec3d point;
        if (!place(track, point))
            continue;
        for (const Ray& ray : track)
            sees[ray.image][size_t(ray.keypoint)] = map.points.rows;
        map.points.push_back(cv::Mat(point.t()));
    }
    if (map.points.empty())
        CV_Error(cv::Error::StsError, folder + ": no point was seen from two places");
    for (size_t i = 0; i < images.size(); i++)
    {
        const cv::Affine3d pose = images[i].cameraFromWorld.inv();
        View view{
                {map.codes.rows, map.codes.rows}, pose.translation(), cv::Vec3d(pose.rotation().col(2).val)};
        std::vector<double> distances;
        for (size_t k = 0; k < sees[i].size(); k++)
            if (sees[i][k] >= 0)
            {
                map.sees.push_back(sees[i][k]);
                map.codes.push_back(features[i].codes.row(int(k)));
                distances.push_back(cv::norm(cv::Vec3d(map.point(sees[i][k])) - view.centre));
            }
        view.rows.end = map.codes.rows;
        if (!distances.empty())
            view.depth = median(distances);
        map.views.push_back(view);
        const Camera& c = images[i].camera;
        if (std::none_of(map.cameras.begin(), map.cameras.end(), [&](const Camera& o) {
                return o.model == c.model && o.size == c.size && o.parameters == c.parameters;
            }))
            map.cameras.push_back(c);
    }
    return map;
}

}  // namespace iib_localization
