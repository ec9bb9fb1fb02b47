// SPDX-License-Identifier: Apache-2.0

#include "walks.hpp"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <map>
#include <sstream>

#include "common/dataset.hpp"
#include "opencv2/core/quaternion.hpp"
#include "opencv2/core/utils/filesystem.hpp"
#include "opencv2/imgcodecs.hpp"

namespace iib_tools {
namespace {

namespace fs = cv::utils::fs;

const double DEPTH_TOLERANCE = 0.02;  // relative difference of depth of a point that both pictures see

const double DEPTH_STEP = .004;  // metres; tools/synthetic/common.inc

std::string depthFile(const std::string& image)
{
    return fs::join(fs::getParent(fs::getParent(image)), "depth/" + baseName(image));
}

//! The pictures under one light, and their poses, camera to world.
struct Walk
{
    cv::Matx33d camera;
    std::vector<std::string> files;
    std::vector<cv::Affine3d> poses;
};

Walk readWalk(const std::string& folder)
{
    Walk walk = {cv::Matx33d::eye(), {}, {}};
    cv::Matx33d& K = walk.camera;
    std::ifstream cameras(fs::join(folder, "cameras.txt")), poses(fs::join(folder, "poses.txt"));
    bool good = true;
    std::string line, name;
    while (std::getline(cameras, line))
        good = good && (line[0] == '#' || std::sscanf(line.c_str(), "1 PINHOLE %*d %*d %lf %lf %lf %lf",
                                                  &K(0, 0), &K(1, 1), &K(0, 2), &K(1, 2)) == 4);
    K = K - cv::Matx33d(0, 0, .5, 0, 0, .5, 0, 0, 0);  // COLMAP's pixels begin at whole numbers
    while (std::getline(poses, line))
        if (line[0] != '#')
        {
            cv::Vec3d at;
            cv::Vec4d q;
            std::istringstream words(line);
            good = good && (words >> name >> at[0] >> at[1] >> at[2] >> q[1] >> q[2] >> q[3] >> q[0]);
            walk.files.push_back(fs::join(folder, "images/" + name + ".png"));
            walk.poses.push_back(cv::Affine3d(cv::Quatd(q).normalize().toRotMat3x3(), at));
        }
    if (!good || K(0, 0) <= 0)
        CV_Error(cv::Error::StsParseError,
                folder + ": not cameras.txt and poses.txt of tools/synthetic/views.py");
    return walk;
}

//! Whether a picture is one of the first two of four: this gives steps of one and three to five, and few repeated views.
bool isUsed(const Walk& walk, int k)
{
    return k % 4 < 2 && fs::exists(walk.files[k]) && fs::exists(depthFile(walk.files[k]));
}

void addPairs(const std::string& scene, const Walk& from, const Walk& to, int farthest,
        std::vector<WalkPair>& pairs)
{
    const int frames = int(std::min(from.files.size(), to.files.size()));
    for (int a = 0; a < frames; a++)
        for (int b = std::max(0, a - farthest); b <= std::min(frames - 1, a + farthest); b++)
            if (a != b && isUsed(from, a) && isUsed(to, b))
                pairs.push_back(
                        {scene, from.files[a], to.files[b], from.camera, to.poses[b].inv() * from.poses[a]});
}

}  // namespace

std::vector<WalkPair> findWalkPairs(const std::vector<std::string>& roots, int farthest)
{
    std::map<std::string, std::vector<Walk>> scenes;
    visitFolders(roots, [&](const std::string& folder) {
        if (holdsViews(folder))
            scenes[fs::getParent(folder)].push_back(readWalk(folder));
        return !holdsViews(folder);
    });
    std::vector<WalkPair> pairs;
    for (const auto& scene : scenes)
        for (const Walk& from : scene.second)
            for (const Walk& to : scene.second)
                addPairs(baseName(fs::getParent(scene.first)) + "/" + baseName(scene.first), from, to,
                        farthest, pairs);
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
    const std::string files[2] = {depthFile(pair.referenceFile), depthFile(pair.targetFile)};
    for (int i = 0; i < 2; i++)
    {
        depths[i] = readImage(files[i], cv::IMREAD_UNCHANGED);
        if (depths[i].type() != CV_16U || depths[i].size() != depths[0].size())
            CV_Error(cv::Error::StsBadArg, files[i] + ": not a 16-bit depth map of the picture's size");
    }
    return {depths[0], depths[1], pair.camera, pair.motion.rotation(),
            pair.motion.translation() / DEPTH_STEP};
}

}  // namespace iib_tools
