// SPDX-License-Identifier: Apache-2.0

#include "map.hpp"

#include <fstream>
#include <sstream>

#include "npy.hpp"
#include "sha256.hpp"

namespace iib_localization {
namespace {

constexpr int FORMAT = 1;

Map readFiles(const std::string& folder)
{
    std::ifstream stream(folder + "/map.json");
    if (!stream)
        CV_Error(cv::Error::StsError, "it has no map.json");
    std::stringstream text;
    text << stream.rdbuf();
    const cv::FileStorage manifest(
            text.str(), cv::FileStorage::READ | cv::FileStorage::MEMORY | cv::FileStorage::FORMAT_JSON);
    if (!manifest["format"].isInt() || int(manifest["format"]) != FORMAT)
        CV_Error(cv::Error::StsError, "its format is unknown to this version");
    for (const cv::FileNode& file : manifest["sha256"])
        if (sha256OfFile(folder + "/" + file.name()) != std::string(file))
            CV_Error(cv::Error::StsError, file.name() + " is damaged");
    Map map;
    map.points = int(manifest["points"]);
    map.model = readModel(folder);
    const cv::Mat codes = readNpy(folder + "/codes.npy");
    int row = 0;
    for (const cv::FileNode& image : manifest["images"])
    {
        const int id = int(image[0]), rows = int(image[1]);
        const auto found = map.model.images.find(id);
        if (found == map.model.images.end() || rows < 0 || rows > codes.rows - row ||
                found->second.points.size() != size_t(rows))
            CV_Error(cv::Error::StsError, cv::format("image %d has not a code for each point", id));
        for (int64_t point : found->second.points)
            if (point < 0)
                CV_Error(cv::Error::StsError, found->second.name + " has a code without a point");
        map.codes[id] = codes.rowRange(row, row + rows);
        row += rows;
    }
    if (map.codes.empty() || map.codes.size() != map.model.images.size() || row != codes.rows ||
            map.points < 1)
        CV_Error(cv::Error::StsError, "it does not have the codes of its images");
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
