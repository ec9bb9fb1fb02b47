// SPDX-License-Identifier: Apache-2.0

#include "map_folder.hpp"

#include <algorithm>
#include <filesystem>

namespace cv::iib {
namespace {

namespace fs = std::filesystem;

//! The files of a map's folder; the first one marks the folder as a map.
const std::vector<std::string> OWN = {"map.iib", "cameras.bin", "images.bin", "points3D.bin"};

}  // namespace

MapFolder::MapFolder(const std::string& folder)
    : folder_(folder, [&](const std::string& name) {
          for (const std::string& own : OWN)
              if (isPartOf(own, name))  // a killed process left the file
              {
                  leftovers_.push_back(name);
                  return true;
              }
          std::error_code error;
          return std::count(OWN.begin(), OWN.end(), name) != 0 &&  // a COLMAP model alone is not a map
                 fs::exists(systemName(endOfLinks(folder) + "/" + OWN[0]), error);
      })
{
}

void MapFolder::write(Map map) const
{
    writeMap(folder_.path(), map, [&] {
        writeModel(folder_.path(), {map.images.begin(), map.images.end()}, map.points);
    });
    std::error_code error;
    for (const std::string& name : leftovers_)
        fs::remove(systemName(folder_.path() + "/" + name), error);
}

}  // namespace cv::iib
