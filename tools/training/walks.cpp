// SPDX-License-Identifier: Apache-2.0

#include "walks.hpp"

#include <algorithm>
#include <cstdlib>
#include <map>

#include "common/dataset.hpp"
#include "opencv2/core/utils/filesystem.hpp"
#include "opencv2/imgcodecs.hpp"

namespace iib_tools {
namespace {

namespace fs = cv::utils::fs;

const double DEPTH_TOLERANCE = 0.02;  // of the depth, for what is seen from both places

struct Walk
{
    std::string folder;
    cv::Matx33d camera;
    double depthScale;                    // metres a step
    std::vector<cv::Mat_<double>> poses;  // [R|t], world to camera

    std::string file(const char* kind, int frame) const
    {
        return fs::join(folder, cv::format("%s/%d.png", kind, frame));
    }
    //! Of four frames the first two: one step apart and three to five, and hardly any view twice.
    bool has(int frame) const
    {
        return (frame - 1) % 4 < 2 && fs::exists(file("frames", frame)) && fs::exists(file("depth", frame));
    }
};

Walk readWalk(const std::string& folder)
{
    const std::string file = fs::join(folder, "camera.yml");
    const cv::FileStorage storage(file, cv::FileStorage::READ);
    cv::Mat camera;
    Walk walk = {folder, cv::Matx33d(), 0, {}};
    storage["camera_matrix"] >> camera;
    storage["depth_scale"] >> walk.depthScale;
    for (const cv::FileNode& node : storage["poses"])
        walk.poses.push_back(node.mat());
    const bool whole = std::all_of(walk.poses.begin(), walk.poses.end(),
            [](const cv::Mat& pose) { return pose.size() == cv::Size(4, 3); });
    if (camera.size() != cv::Size(3, 3) || !(walk.depthScale > 0) || walk.poses.empty() || !whole)
        CV_Error(cv::Error::StsParseError, file + ": not camera_matrix, depth_scale and poses of a walk");
    walk.camera = cv::Mat_<double>(camera);
    return walk;
}

cv::Matx33d rotationOf(const cv::Mat_<double>& pose) { return cv::Mat_<double>(pose.colRange(0, 3)); }
cv::Vec3d translationOf(const cv::Mat_<double>& pose) { return cv::Mat_<double>(pose.col(3)); }

void addPairs(const std::string& scene, const Walk& from, const Walk& to, int farthest,
        std::vector<WalkPair>& pairs)
{
    const int frames = int(std::min(from.poses.size(), to.poses.size()));
    for (int a = 1; a <= frames; a++)
        for (int b = std::max(1, a - farthest); b <= std::min(frames, a + farthest); b++)
            if (a != b && from.has(a) && to.has(b))
            {
                const cv::Matx33d rotation = rotationOf(to.poses[b - 1]) * rotationOf(from.poses[a - 1]).t();
                const cv::Vec3d metres =
                        translationOf(to.poses[b - 1]) - rotation * translationOf(from.poses[a - 1]);
                pairs.push_back({scene, from.file("frames", a), to.file("frames", b), from.file("depth", a),
                        to.file("depth", b), from.camera, rotation, metres / from.depthScale});
            }
}

void search(const std::string& folder, int depth, int farthest, std::vector<WalkPair>& pairs)
{
    std::vector<cv::String> entries;
    fs::glob(folder, "*", entries, false, true);
    std::sort(entries.begin(), entries.end());
    std::map<std::string, std::vector<Walk>> walks;  // by scene
    for (const std::string& entry : entries)
        if (fs::isDirectory(fs::join(entry, "frames")) && fs::exists(fs::join(entry, "camera.yml")))
        {
            const std::string name = entry.substr(entry.find_last_of('/') + 1);
            walks[name.substr(0, name.find_last_of('_'))].push_back(readWalk(entry));
        }
        else if (depth > 0 && fs::isDirectory(entry))
            search(entry, depth - 1, farthest, pairs);
    for (const auto& scene : walks)
        for (const Walk& from : scene.second)
            for (const Walk& to : scene.second)
                addPairs(folder.substr(folder.find_last_of('/') + 1) + "/" + scene.first, from, to, farthest,
                        pairs);
}

}  // namespace

std::vector<WalkPair> findWalkPairs(const std::vector<std::string>& roots, int farthest)
{
    std::vector<WalkPair> pairs;
    for (const std::string& root : roots)
        if (fs::isDirectory(root))
            search(fs::canonical(root), 3, farthest, pairs);
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
            CV_Error(cv::Error::StsBadArg, files[i] + ": not depth of 16 bits of the other picture's size");
    }
    return {depths[0], depths[1], pair.camera, pair.rotation, pair.translation};
}

}  // namespace iib_tools
