// SPDX-License-Identifier: Apache-2.0

#include "rays.hpp"

#include <set>

#include "features.hpp"
#include "pose.hpp"

namespace iib_localization {
namespace {

constexpr double MAX_ERROR = 4;  // pixels, of a match from its epipolar line
constexpr double FAR = .01;      // radians between rays that do not tell on which side they meet

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

}  // namespace

double Ray::error(const cv::Vec3d& at) const
{
    const cv::Vec3d way = at - centre;
    return scale * std::atan2(cv::norm(way.cross(direction)), way.dot(direction));
}

std::vector<Ray> raysOf(size_t number, const PosedImage& image)
{
    const Lens lens(image.camera);
    const cv::Affine3d pose = inverse(image.cameraFromWorld);
    const cv::Matx33d toWorld = pose.rotation() * lens.matrix().inv();
    std::vector<Ray> rays;
    for (const cv::Point2d& p : lens.undistorted(image.pixels))
    {
        const int keypoint = int(rays.size());
        const int point = image.sees.empty() ? -1 : image.sees[size_t(keypoint)];
        rays.push_back({number, keypoint, pose.translation(), cv::normalize(toWorld * cv::Vec3d(p.x, p.y, 1)),
                lens.matrix()(0, 0), point});
    }
    return rays;
}

MatchedRays matchPairs(const std::vector<MapImage>& images,
        const std::vector<std::pair<size_t, size_t>>& pairs, const std::function<void()>& step)
{
    const cv::Ptr<cv::iib::HierarchicalMatcher> matcher = cv::iib::HierarchicalMatcher::createRecommended();
    std::vector<std::vector<cv::DMatch>> matches(pairs.size());
    inParallel(pairs.size(), [&](size_t n) {
        const cv::Mat &a = images[pairs[n].first].codes, &b = images[pairs[n].second].codes;
        if (!a.empty() && !b.empty())
            matcher->match(a, b, matches[n]);
        step();
    });
    MatchedRays found;
    std::set<size_t> involved;
    for (const auto& [a, b] : pairs)
        involved.insert({a, b});
    std::vector<size_t> first(images.size());
    for (size_t i : involved)
    {
        first[i] = found.rays.size();
        const std::vector<Ray> own = raysOf(i, images[i]);
        found.rays.insert(found.rays.end(), own.begin(), own.end());
    }
    for (size_t n = 0; n < pairs.size(); n++)
        for (const cv::DMatch& m : matches[n])
        {
            const size_t a = first[pairs[n].first] + size_t(m.queryIdx),
                         b = first[pairs[n].second] + size_t(m.trainIdx);
            found.matches++;
            if (fitting(found.rays[a], found.rays[b]))
                found.links.push_back({m.distance, a, b});
        }
    return found;
}

}  // namespace iib_localization
