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

void addWithin(const std::string& set, const ViewFolder& folder, std::vector<ViewPair>& pairs)
{
    for (size_t i = 0; i < folder.views.size(); i++)
        for (size_t j = i + 1; j < std::min(folder.views.size(), i + 1 + NEIGHBOURS); j++)
            pairs.push_back(pairOf(set, folder, folder.views[i], folder, folder.views[j]));
}

//! Pairs the images of the other folders with those of `map`; false if `map` or others are missing.
bool addAcross(const std::string& set, const std::vector<ViewFolder>& folders, std::vector<ViewPair>& pairs)
{
    const auto mapped = std::find_if(
            folders.begin(), folders.end(), [](const ViewFolder& folder) { return folder.name == "map"; });
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

}  // namespace

ViewPair pairOf(
        const std::string& set, const ViewFolder& from, const View& a, const ViewFolder& to, const View& b)
{
    const cv::Matx33d toTarget = b.rotation.t();
    return {set, to.name, a.name + "-" + b.name, a.file, b.file, from.camera, to.camera,
            toTarget * a.rotation, toTarget * (a.position - b.position), &from == &to};
}

std::string depthFile(const std::string& imageFile)
{
    return fs::join(fs::getParent(fs::getParent(imageFile)), "depth/" + stem(imageFile) + ".png");
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
    std::vector<ViewPair> pairs;
    for (const auto& place : findViewFolders(roots))
        if (!addAcross(baseName(place.first), place.second, pairs))
            for (const ViewFolder& folder : place.second)
                addWithin(baseName(place.first), folder, pairs);
    return pairs;
}

}  // namespace iib_tools
