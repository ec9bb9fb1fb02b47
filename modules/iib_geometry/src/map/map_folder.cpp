// SPDX-License-Identifier: Apache-2.0

#include "map_folder.hpp"

#include <algorithm>
#include <filesystem>

namespace cv::iib {
namespace {

namespace fs = std::filesystem;

//! What a folder of a map holds, and one of an earlier version; the first names tell that it is one.
const std::vector<std::string> OWN = {"map.iib", "cameras.bin", "images.bin", "points3D.bin"};
const std::vector<std::string> EARLIER = {"map.json", "codes.npy", "misses.npy", "points.npy", "sees.npy",
        "views.npy", "rigs.bin", "frames.bin"};

bool isOneOf(const std::vector<std::string>& names, const std::string& name)
{
    return std::count(names.begin(), names.end(), name) != 0;
}

//! Whether a killed process has left it.
bool isUnfinished(const std::string& name)
{
    return std::any_of(OWN.begin(), OWN.end(), [&](const std::string& own) { return isPartOf(own, name); });
}

}  // namespace

MapFolder::MapFolder(const std::string& folder)
    : folder_(folder, [&](const std::string& name) {
          const auto has = [&](const std::string& mark) {
              std::error_code error;
              return fs::exists(systemName(endOfLinks(folder) + "/" + mark), error);
          };
          if (isUnfinished(name) || (isOneOf(EARLIER, name) && has(EARLIER[0])))
          {
              replaced_.push_back(name);
              return true;
          }
          return isOneOf(OWN, name) && (has(OWN[0]) || has(EARLIER[0]));  // a COLMAP model alone is no map
      })
{
}

void MapFolder::write(const Map& map) const
{
    writeMap(folder_.path(), map, [&] {
        writeModel(folder_.path(), {map.images.begin(), map.images.end()}, map.points);
    });
    std::error_code error;
    for (const std::string& name : replaced_)
        fs::remove(systemName(folder_.path() + "/" + name), error);
}

}  // namespace cv::iib
