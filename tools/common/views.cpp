// SPDX-License-Identifier: Apache-2.0

#include "views.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <functional>
#include <map>
#include <sstream>

#include "opencv2/core/quaternion.hpp"
#include "opencv2/core/utils/filesystem.hpp"

namespace iib_tools {
namespace {

namespace fs = cv::utils::fs;

const int NEIGHBOURS = 3;           // pairs an image in its own folder
const double LEAST_BASELINE = 0.5;  // metres, so that the direction of the movement can be seen

struct View
{
    std::string name, file;
    cv::Matx33d rotation;  // camera to world
    cv::Vec3d position;
};

struct Folder
{
    std::string name;
    cv::Matx33d camera;
    std::vector<View> views;
};

//! Calls `line` with each line but empty ones and comments; it returns false for what it does not understand.
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
        CV_Error(cv::Error::StsParseError, file + ": not one PINHOLE camera");
    return camera -
           cv::Matx33d(0, 0, .5, 0, 0, .5, 0, 0, 0);  // of COLMAP, whose pixels begin at whole numbers
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

std::string lastName(const std::string& path) { return path.substr(path.find_last_of('/') + 1); }

Folder readFolder(const std::string& path)
{
    return {lastName(path), readCamera(fs::join(path, "cameras.txt")), readViews(path)};
}

bool holdsWalk(const std::string& folder)
{
    return fs::exists(fs::join(folder, "camera.yml")) && fs::isDirectory(fs::join(folder, "frames"));
}

Folder readWalk(const std::string& path, const std::string& light)
{
    const cv::FileStorage storage(fs::join(path, "camera.yml"), cv::FileStorage::READ);
    Folder walk = {light, cv::Matx33d(storage["camera_matrix"].mat()), {}};
    int number = 0;
    for (const cv::FileNode& node : storage["poses"])
    {
        const cv::Mat pose = node.mat();
        const cv::Matx33d rotation = cv::Matx33d(pose.colRange(0, 3)).t();
        const std::string name = cv::format("%02d", ++number),
                          file = fs::join(path, cv::format("frames/%d.png", number));
        if (fs::exists(file))
            walk.views.push_back({name, file, rotation, -(rotation * cv::Vec3d(pose.col(3)))});
    }
    return walk;
}

ViewPair pairOf(const std::string& set, const Folder& from, const View& a, const Folder& to, const View& b)
{
    const cv::Matx33d toTarget = b.rotation.t();
    return {set, to.name, a.name + "-" + b.name, a.file, b.file, from.camera, to.camera,
            toTarget * a.rotation, toTarget * (a.position - b.position), &from == &to};
}

void addWithin(const std::string& set, const Folder& folder, std::vector<ViewPair>& pairs)
{
    for (size_t i = 0; i < folder.views.size(); i++)
        for (size_t j = i + 1; j < std::min(folder.views.size(), i + 1 + NEIGHBOURS); j++)
            pairs.push_back(pairOf(set, folder, folder.views[i], folder, folder.views[j]));
}

void addAcross(const std::string& set, const Folder& map, const Folder& visit, std::vector<ViewPair>& pairs)
{
    for (const View& view : visit.views)
    {
        const View* best = nullptr;
        double least = 0;
        for (const View& candidate : map.views)
        {
            const double distance = cv::norm(candidate.position - view.position);
            if (distance >= LEAST_BASELINE && (!best || distance < least))
            {
                best = &candidate;
                least = distance;
            }
        }
        if (best)
            pairs.push_back(pairOf(set, map, *best, visit, view));
    }
}

void search(const std::string& folder, int depth, std::vector<ViewPair>& pairs)
{
    std::vector<cv::String> entries, views;
    std::map<std::string, std::map<std::string, Folder>> walks;  // by scene and light
    fs::glob(folder, "*", entries, false, true);
    std::sort(entries.begin(), entries.end());
    for (const std::string& entry : entries)
        if (holdsViews(entry))
            views.push_back(entry);
        else if (holdsWalk(entry))
        {
            const std::string name = lastName(entry), light = name.substr(name.find_last_of('_') + 1);
            walks["walk_" + name.substr(0, name.find_last_of('_'))][light] = readWalk(entry, light);
        }
        else if (depth > 0 && fs::isDirectory(entry))
            search(entry, depth - 1, pairs);
    const std::string map = fs::join(folder, "map");
    const bool visited = holdsViews(map) && views.size() > 1;
    for (const std::string& view : views)
        if (!visited)
            addWithin(lastName(folder), readFolder(view), pairs);
        else if (view != map)
            addAcross(lastName(folder), readFolder(map), readFolder(view), pairs);
    for (auto& walk : walks)
        for (const auto& light : walk.second)
            if (light.first != "noon")
                addAcross(walk.first, walk.second["noon"], light.second, pairs);
}

}  // namespace

bool holdsViews(const std::string& folder)
{
    return fs::exists(fs::join(folder, "cameras.txt")) && fs::exists(fs::join(folder, "poses.txt")) &&
           fs::isDirectory(fs::join(folder, "images"));
}

std::vector<ViewPair> findViewPairs(const std::vector<std::string>& roots)
{
    std::vector<ViewPair> pairs;
    for (const std::string& root : roots)
        if (fs::isDirectory(root))
            search(fs::canonical(root), 3, pairs);
    return pairs;
}

}  // namespace iib_tools
