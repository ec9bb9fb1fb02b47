// SPDX-License-Identifier: Apache-2.0

#include "map.hpp"

#include <fstream>
#include <sstream>

#include "npy.hpp"

namespace iib_localization {
namespace {

constexpr int FORMAT = 2;

Map readFiles(const std::string& folder)
{
    std::ifstream stream(folder + "/map.json");
    if (!stream)
        CV_Error(cv::Error::StsError, "it has no map.json");
    std::stringstream text;
    text << stream.rdbuf();
    cv::FileStorage manifest;
    try
    {
        manifest.open(
                text.str(), cv::FileStorage::READ | cv::FileStorage::MEMORY | cv::FileStorage::FORMAT_JSON);
    }
    catch (const cv::Exception&)  // which says where in OpenCV's parser
    {
        CV_Error(cv::Error::StsParseError, "map.json is damaged");
    }
    if (!manifest["format"].isInt() || int(manifest["format"]) != FORMAT)
        CV_Error(cv::Error::StsError, "its format is not that of this version: make it again");
    const auto array = [&](const std::string& name, int type) {
        return readNpy(folder + "/" + name, type, std::string(manifest["crc32"][name]));
    };
    Map map;
    map.keypoints = int(manifest["points"]);
    map.codes = array("codes.npy", CV_8U);
    map.sees = array("sees.npy", CV_32S);
    map.points = array("points.npy", CV_64F);
    const cv::Mat views = array("views.npy", CV_64F);
    for (const cv::FileNode& c : manifest["cameras"])
    {
        map.cameras.push_back({std::string(c[0]), {int(c[1]), int(c[2])}, {}});
        c[3] >> map.cameras.back().parameters;
    }
    const cv::FileNode images = manifest["images"];
    bool valid = map.keypoints > 0 && views.rows > 0 && views.rows == int(images.size()) && views.cols == 7 &&
                 map.points.cols == 3 && map.sees.cols == 1 && map.sees.rows == map.codes.rows &&
                 cv::checkRange(map.sees, true, nullptr, 0, map.points.rows);
    for (int i = 0, row = 0; valid && i < views.rows; i++)
    {
        const double* v = views.ptr<double>(i);
        const int count = int(images[i][1]), left = map.codes.rows - row;
        valid = count >= 0 && (i + 1 < views.rows ? count <= left : count == left);
        map.views.push_back({{row, valid ? row + count : row}, cv::Vec3d(v), cv::Vec3d(v + 3), v[6]});
        row = map.views.back().rows.end;
    }
    if (!valid)
        CV_Error(cv::Error::StsError, "its files contradict each other");
    return map;
}

}  // namespace

Map readMap(const std::string& folder)
{
    try
    {
        return readFiles(folder);
    }
    catch (const cv::Exception& e)
    {
        CV_Error(cv::Error::StsError, folder + " is no map, or a damaged one: " + e.err);
    }
}

}  // namespace iib_localization
