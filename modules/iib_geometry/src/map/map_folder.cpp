// SPDX-License-Identifier: Apache-2.0

#include "map_folder.hpp"

#include <algorithm>
#include <filesystem>

namespace cv::iib {
namespace {

namespace fs = std::filesystem;

//! What a folder of a map holds; the first name tells that it is one.
const std::vector<std::string> OWN = {"map.iib", "cameras.bin", "images.bin", "points3D.bin"};

//! Whether a killed process has left it.
bool isUnfinished(const std::string& name)
{
    return std::any_of(OWN.begin(), OWN.end(), [&](const std::string& own) { return isPartOf(own, name); });
}

}  // namespace

MapFolder::MapFolder(const std::string& folder)
    : folder_(folder, [&](const std::string& name) {
          if (isUnfinished(name))
          {
              replaced_.push_back(name);
              return true;
          }
          std::error_code error;
          return std::count(OWN.begin(), OWN.end(), name) != 0 &&  // a COLMAP model alone is no map
                 fs::exists(systemName(endOfLinks(folder) + "/" + OWN[0]), error);
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
