// SPDX-License-Identifier: Apache-2.0

#include "views.hpp"

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <fstream>
#include <functional>
#include <map>
#include <sstream>

#include "dataset.hpp"
#include "opencv2/core/quaternion.hpp"
#include "opencv2/core/utils/filesystem.hpp"

namespace iib_tools {
namespace {

namespace fs = cv::utils::fs;

const int NEIGHBOURS = 3;           // pairs an image in its own folder
const double LEAST_BASELINE = 0.5;  // metres, so that the direction of the translation is determined

//! Calls `line` with each line except empty ones and comments; it returns false for an invalid line.
void eachLine(const std::string& file, const std::function<bool(std::istringstream&)>& line)
{
    std::ifstream in(file);
    if (!in)
        CV_Error(cv::Error::StsObjectNotFound, file + ": cannot be read");
    std::string text;
    for (int number = 1; std::getline(in, text); number++)
    {
        std::istringstream words(text);
        if (!text.empty() && text[0] != '#' && !line(words))
            CV_Error(cv::Error::StsParseError,
                    cv::format("%s, line %d: not as expected", file.c_str(), number));
    }
}

cv::Matx33d readCamera(const std::string& file)
{
    int count = 0;
    cv::Matx33d camera = cv::Matx33d::eye();
    eachLine(file, [&](std::istringstream& words) {
        std::string id, model;
        double width = 0, height = 0;
        count++;
        return (words >> id >> model >> width >> height >> camera(0, 0) >> camera(1, 1) >> camera(0, 2) >>
                       camera(1, 2)) &&
               model == "PINHOLE" && camera(0, 0) > 0 && camera(1, 1) > 0;
    });
    if (count != 1)
        CV_Error(cv::Error::StsParseError, file + ": needs exactly one PINHOLE camera");
    // COLMAP's pixels begin at whole numbers
    return camera - cv::Matx33d(0, 0, .5, 0, 0, .5, 0, 0, 0);
}

std::vector<View> readViews(const std::string& folder)
{
    std::vector<View> views;
    eachLine(fs::join(folder, "poses.txt"), [&](std::istringstream& words) {
        View v;
        cv::Vec4d q;
        if (!(words >> v.name >> v.position[0] >> v.position[1] >> v.position[2] >> q[0] >> q[1] >> q[2] >>
                    q[3]) ||
                !(std::abs(cv::norm(q) - 1) < 1e-2))
            return false;
        v.rotation = cv::Quatd(q[3], q[0], q[1], q[2]).normalize().toRotMat3x3();
        for (const char* extension : {".png", ".jpg"})
            if (fs::exists(fs::join(folder, "images/" + v.name + extension)))
                v.file = fs::join(folder, "images/" + v.name + extension);
        if (!v.file.empty())
            views.push_back(v);
        return true;
    });
    return views;
}

ViewFolder viewsOf(const Walk& walk)
{
    ViewFolder folder = {walk.light, walk.camera, {}};
    for (int k = 1; k <= int(walk.poses.size()); k++)
    {
        const cv::Matx33d toWorld = walk.poses[k - 1].rotation().t();
        if (fs::exists(walk.file("frames", k)))
            folder.views.push_back({cv::format("%02d", k), walk.file("frames", k), toWorld,
                    -(toWorld * walk.poses[k - 1].translation())});
    }
    return folder;
}

ViewPair pairOf(
        const std::string& set, const ViewFolder& from, const View& a, const ViewFolder& to, const View& b)
{
    const cv::Matx33d toTarget = b.rotation.t();
    return {set, to.name, a.name + "-" + b.name, a.file, b.file, from.camera, to.camera,
            toTarget * a.rotation, toTarget * (a.position - b.position), &from == &to, 0, 0};
}

void addWithin(const std::string& set, const ViewFolder& folder, std::vector<ViewPair>& pairs)
{
    for (size_t i = 0; i < folder.views.size(); i++)
        for (size_t j = i + 1; j < std::min(folder.views.size(), i + 1 + NEIGHBOURS); j++)
            pairs.push_back(pairOf(set, folder, folder.views[i], folder, folder.views[j]));
}

//! Pairs the images of the other folders with those of `map`; false if `map` or others are missing.
bool addAcross(const std::string& set, const std::string& map, const std::vector<ViewFolder>& folders,
        std::vector<ViewPair>& pairs)
{
    const auto mapped = std::find_if(
            folders.begin(), folders.end(), [&](const ViewFolder& folder) { return folder.name == map; });
    if (mapped == folders.end() || folders.size() == 1)
        return false;
    for (const ViewFolder& visit : folders)
        for (const View& view : visit.views)
        {
            const View* best = nullptr;
            double least = DBL_MAX;
            for (const View& candidate : mapped->views)
            {
                const double distance = cv::norm(candidate.position - view.position);
                if (distance >= LEAST_BASELINE && distance < least)
                {
                    best = &candidate;
                    least = distance;
                }
            }
            if (best && &visit != &*mapped)
                pairs.push_back(pairOf(set, *mapped, *best, visit, view));
        }
    return true;
}

Walk readWalk(const std::string& folder)
{
    const std::string name = baseName(folder), file = fs::join(folder, "camera.yml");
    const cv::FileStorage storage(file, cv::FileStorage::READ);
    const cv::Mat camera = storage["camera_matrix"].mat();
    Walk walk = {folder, name.substr(0, name.find_last_of('_')), name.substr(name.find_last_of('_') + 1),
            cv::Matx33d(), storage["depth_scale"].real(), {}};
    bool whole = camera.size() == cv::Size(3, 3) && walk.depthScale > 0;
    for (const cv::FileNode& node : storage["poses"])
    {
        const cv::Mat pose = node.mat();
        whole = whole && pose.size() == cv::Size(4, 3);
        if (whole)
            walk.poses.push_back(cv::Affine3d(pose));
    }
    if (!whole || walk.poses.empty())
        CV_Error(cv::Error::StsParseError, file + ": not camera_matrix, depth_scale and poses of a walk");
    walk.camera = camera;
    return walk;
}

}  // namespace

std::string Walk::file(const char* kind, int frame) const
{
    return fs::join(folder, cv::format("%s/%d.png", kind, frame));
}

std::vector<Walk> findWalks(const std::vector<std::string>& roots)
{
    std::vector<Walk> walks;
    visitFolders(roots, [&](const std::string& folder) {
        const bool found =
                fs::isDirectory(fs::join(folder, "frames")) && fs::exists(fs::join(folder, "camera.yml"));
        if (found)
            walks.push_back(readWalk(folder));
        return !found;
    });
    return walks;
}

bool holdsViews(const std::string& folder)
{
    return fs::exists(fs::join(folder, "cameras.txt")) && fs::exists(fs::join(folder, "poses.txt")) &&
           fs::isDirectory(fs::join(folder, "images"));
}

std::map<std::string, std::vector<ViewFolder>> findViewFolders(const std::vector<std::string>& roots)
{
    std::map<std::string, std::vector<ViewFolder>> places;
    visitFolders(roots, [&](const std::string& folder) {
        const bool found = holdsViews(folder);
        if (found)
            places[fs::getParent(folder)].push_back(
                    {baseName(folder), readCamera(fs::join(folder, "cameras.txt")), readViews(folder)});
        return !found;
    });
    return places;
}

std::vector<ViewPair> findViewPairs(const std::vector<std::string>& roots)
{
    std::map<std::string, std::vector<ViewFolder>> scenes;
    for (const Walk& walk : findWalks(roots))
        scenes[fs::join(fs::getParent(walk.folder), "walk_" + walk.scene)].push_back(viewsOf(walk));
    std::vector<ViewPair> pairs;
    for (const auto& place : findViewFolders(roots))
        if (!addAcross(baseName(place.first), "map", place.second, pairs))
            for (const ViewFolder& folder : place.second)
                addWithin(baseName(place.first), folder, pairs);
    for (const auto& scene : scenes)
        addAcross(baseName(scene.first), "noon", scene.second, pairs);
    return pairs;
}

}  // namespace iib_tools
