// SPDX-License-Identifier: Apache-2.0

#include "walks.hpp"

#include <algorithm>
#include <cstdlib>

#include "common/dataset.hpp"
#include "common/views.hpp"
#include "opencv2/core/utils/filesystem.hpp"
#include "opencv2/imgcodecs.hpp"

namespace iib_tools {
namespace {

namespace fs = cv::utils::fs;

const double DEPTH_TOLERANCE = 0.02;  // relative difference of depth of a point that both pictures see

//! Whether a frame is one of the first two of four: this gives steps of one and three to five, and few repeated views.
bool isUsed(const Walk& walk, int frame)
{
    return (frame - 1) % 4 < 2 && fs::exists(walk.file("frames", frame)) &&
           fs::exists(walk.file("depth", frame));
}

void addPairs(const Walk& from, const Walk& to, int farthest, std::vector<WalkPair>& pairs)
{
    const int frames = int(std::min(from.poses.size(), to.poses.size()));
    for (int a = 1; a <= frames; a++)
        for (int b = std::max(1, a - farthest); b <= std::min(frames, a + farthest); b++)
            if (a != b && isUsed(from, a) && isUsed(to, b))
            {
                const cv::Affine3d &first = from.poses[a - 1], &second = to.poses[b - 1];
                const cv::Matx33d rotation = second.rotation() * first.rotation().t();
                const cv::Vec3d metres = second.translation() - rotation * first.translation();
                pairs.push_back({baseName(fs::getParent(from.folder)) + "/" + from.scene,
                        from.file("frames", a), to.file("frames", b), from.file("depth", a),
                        to.file("depth", b), from.camera, rotation, metres / from.depthScale});
            }
}

}  // namespace

std::vector<WalkPair> findWalkPairs(const std::vector<std::string>& roots, int farthest)
{
    const std::vector<Walk> walks = findWalks(roots);
    std::vector<WalkPair> pairs;
    for (const Walk& from : walks)
        for (const Walk& to : walks)
            if (from.scene == to.scene && fs::getParent(from.folder) == fs::getParent(to.folder))
                addPairs(from, to, farthest, pairs);
    return pairs;
}

cv::KeyPoint Relief::project(const cv::KeyPoint& keypoint) const
{
    cv::KeyPoint seen = keypoint;
    seen.size = 0;
    const cv::Rect picture(cv::Point(), reference.size());
    const cv::Point from(cvRound(keypoint.pt.x), cvRound(keypoint.pt.y));
    const double depth = picture.contains(from) ? reference(from) : 0;
    if (depth == 0 || depth == USHRT_MAX)
        return seen;
    const cv::Vec3d ray = camera.inv() * cv::Vec3d(keypoint.pt.x, keypoint.pt.y, 1);
    const cv::Vec3d there = rotation * ray * depth + translation, image = camera * there;
    if (!(there[2] > 0))
        return seen;
    seen.pt = cv::Point2f(float(image[0] / image[2]), float(image[1] / image[2]));
    const cv::Point to(cvRound(seen.pt.x), cvRound(seen.pt.y));
    if (picture.contains(to) && std::abs(target(to) - there[2]) <= DEPTH_TOLERANCE * there[2])
        seen.size = float(keypoint.size * depth / there[2]);
    return seen;
}

void Relief::mirror()
{
    const cv::Matx33d flip(-1, 0, 0, 0, 1, 0, 0, 0, 1);
    cv::flip(reference, reference, 1);
    cv::flip(target, target, 1);
    camera(0, 2) = reference.cols - 1 - camera(0, 2);
    rotation = flip * rotation * flip;
    translation = flip * translation;
}

Relief loadRelief(const WalkPair& pair)
{
    cv::Mat depths[2];
    const std::string files[2] = {pair.referenceDepth, pair.targetDepth};
    for (int i = 0; i < 2; i++)
    {
        depths[i] = readImage(files[i], cv::IMREAD_UNCHANGED);
        if (depths[i].type() != CV_16U || depths[i].size() != depths[0].size())
            CV_Error(cv::Error::StsBadArg, files[i] + ": not a 16-bit depth map of the picture's size");
    }
    return {depths[0], depths[1], pair.camera, pair.rotation, pair.translation};
}

}  // namespace iib_tools
