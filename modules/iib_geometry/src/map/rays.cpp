// SPDX-License-Identifier: Apache-2.0

#include "rays.hpp"

#include <algorithm>
#include <set>

#include "opencv2/iib.hpp"
#include "../common/parallel.hpp"
#include "../pose/camera_pose.hpp"

namespace cv::iib {
namespace {

constexpr double MAX_ERROR = 4;       // pixels from the epipolar line, of any match
constexpr double MAX_GUIDED = 2;      // pixels from the epipolar line, of a guided match
constexpr int MASK_ROWS = 32;         // of a mask computed at once, to stay in the caches
constexpr int STRONGEST = 200;        // codes of an image by which its pose is checked
constexpr double MIN_CROSSING = .01;  // radians: more parallel rays may meet on either side within the noise

/** Whether two rays satisfy the epipolar constraint d_a (baseline x d_b) = 0 (Hartley and Zisserman 2004, section 9.6),
in pixels, and meet before both cameras. */
bool areConsistent(const Ray& a, const Ray& b)
{
    const Vec3d baseline = b.centre - a.centre, across = a.direction.cross(b.direction);
    const Vec3d planeA = baseline.cross(b.direction), planeB = baseline.cross(a.direction);
    const double product = std::abs(a.direction.dot(planeA));
    return a.scale * product < MAX_ERROR * norm(planeA) && b.scale * product < MAX_ERROR * norm(planeB) &&
           (norm(across) < MIN_CROSSING || (across.dot(planeA) > 0 && across.dot(planeB) > 0));
}

//! Mask of the rays of two images (rows and columns) that satisfy the epipolar constraint.
Mat nearEpipolar(const std::vector<Ray>& a, const std::vector<Ray>& b)
{
    Mat_<float> directions(int(a.size()), 3), planes(int(b.size()), 3);
    for (size_t i = 0; i < a.size(); i++)
        Mat(Vec3f(a[i].direction)).reshape(1, 1).copyTo(directions.row(int(i)));
    for (size_t i = 0; i < b.size(); i++)
        Mat(Vec3f(normalize((b[i].centre - a[0].centre).cross(b[i].direction))))
                .reshape(1, 1)
                .copyTo(planes.row(int(i)));
    Mat mask(directions.rows, planes.rows, CV_8U), products;
    for (int row = 0; row < mask.rows; row += MASK_ROWS)
    {
        const Range rows(row, std::min(row + MASK_ROWS, mask.rows));
        gemm(directions.rowRange(rows), planes, 1, noArray(), 0, products, GEMM_2_T);
        compare(abs(products), MAX_GUIDED / a[0].scale, mask.rowRange(rows), CMP_LT);
    }
    return mask;
}

Mat strongest(const Mat& codes) { return codes.rowRange(0, std::min(codes.rows, STRONGEST)); }

}  // namespace

double Ray::error(const Vec3d& at) const
{
    const Vec3d offset = at - centre;
    return scale * std::atan2(norm(offset.cross(direction)), offset.dot(direction));
}

std::vector<Ray> raysOf(size_t number, const PosedImage& image)
{
    const Lens lens(image.camera);
    const Affine3d pose = inverse(image.cameraFromWorld);
    const Matx33d toWorld = pose.rotation() * lens.matrix().inv();
    std::vector<Ray> rays;
    for (const Point2d& p : lens.undistorted(image.pixels))
    {
        const int keypoint = int(rays.size());
        const int point = image.sees.empty() ? -1 : image.sees[size_t(keypoint)];
        rays.push_back({number, keypoint, pose.translation(), normalize(toWorld * Vec3d(p.x, p.y, 1)),
                lens.matrix()(0, 0), point});
    }
    return rays;
}

MatchedRays matchPairs(
        const std::vector<MapImage>& images, const Pairs& pairs, const std::function<void()>& step)
{
    const Ptr<HierarchicalMatcher> matcher = HierarchicalMatcher::createRecommended();
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
    std::vector<std::vector<RayMatch>> links(pairs.size());
    std::atomic<size_t> unguided(0), consistent(0);
    inParallel(pairs.size(), [&](size_t n) {
        const size_t a = pairs[n].first, b = pairs[n].second;
        const Mat &codes = images[a].codes, &others = images[b].codes;
        const auto raysFrom = [&](size_t i) {
            const auto begin = found.rays.begin() + ptrdiff_t(first[i]);
            return std::vector<Ray>(begin, begin + images[i].codes.rows);
        };
        std::vector<DMatch> matches, guided;
        if (!codes.empty() && !others.empty())
        {
            matcher->match(strongest(codes), strongest(others), matches);
            matcher->match(codes, others, guided, nearEpipolar(raysFrom(a), raysFrom(b)));
        }
        const auto linkOf = [&](const DMatch& m) {
            return RayMatch{m.distance, uint32_t(first[a] + size_t(m.queryIdx)),
                    uint32_t(first[b] + size_t(m.trainIdx))};
        };
        const auto fits = [&](const DMatch& m) {
            return areConsistent(found.rays[linkOf(m).a], found.rays[linkOf(m).b]);
        };
        unguided += matches.size();
        consistent += size_t(std::count_if(matches.begin(), matches.end(), fits));
        for (const DMatch& m : guided)
            if (fits(m))
                links[n].push_back(linkOf(m));
        step();
    });
    found.matches = unguided;
    found.consistent = consistent;
    for (std::vector<RayMatch>& some : links)
    {
        found.links.insert(found.links.end(), some.begin(), some.end());
        some = {};
    }
    return found;
}

}  // namespace cv::iib
