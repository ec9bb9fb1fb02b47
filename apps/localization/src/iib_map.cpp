// SPDX-License-Identifier: Apache-2.0

#include <iostream>

#include "common/command_line.hpp"
#include "line_features.hpp"
#include "localizer.hpp"
#include "map_builder.hpp"

namespace {
using namespace iib_localization;

void printInfo(const Map& map)
{
    const size_t keyframes = map.model.keyframes.size();
    const Localizer localizer(map, map.model.cameras.begin()->second);
    std::cout << keyframes << " keyframes, " << map.model.points.size() << " points, "
              << map.lines.lines.size() << " lines, features " << map.description
              << "\nbytes a keyframe: codes " << map.codeBytes() / keyframes << ", points "
              << map.pointBytes() / keyframes << ", retrieval " << localizer.retrievalBytes() / keyframes
              << ", lines " << map.lines.bytes() / keyframes << "\n";
}

int run(const iib_tools::CommandLine& line)
{
    const std::vector<std::string>& words = line.positional();
    if (words.size() == 2 && words[0] == "info")
    {
        printInfo(readMap(words[1]));
        return 0;
    }
    if (words.size() != 1 || words[0] != "build")
        CV_Error(cv::Error::StsBadArg, "neither `build` nor `info MAP` (--help tells more)");
    for (const char* needed : {"images", "cameras", "poses", "out"})
        if (!line.has(needed))
            CV_Error(cv::Error::StsBadArg, cv::format("build needs --%s", needed));
    MapSources sources;
    sources.images = line.text("images");
    sources.cameras = line.text("cameras");
    sources.poses = line.text("poses");
    sources.depth = line.text("depth");
    sources.features = line.text("features");
    sources.refinePoses = line.has("refine-poses");
    NewFolder place = placeOfMap(line.text("out"));
    const Map map = buildMap(sources);
    if (!linesAvailable())
        std::cerr << "the map has no lines: this program was built without OpenCV's line_descriptor\n";
    writeMap(std::move(place), map);
    printInfo(map);
    return 0;
}

}  // namespace

int main(int argc, char** argv)
{
    return iib_tools::runTool(argc, argv,
            "Makes a map that iib_localize finds cameras in.\n"
            "  iib_map build --images DIR --cameras cameras.txt --poses poses.txt [--depth DIR] --out MAP\n"
            "  iib_map info MAP",
            "{images|<none>|folder of the images}"
            "{cameras|<none>|COLMAP's cameras.txt}"
            "{poses|<none>|TUM's poses, camera to world, or the folder of a COLMAP model}"
            "{depth|<none>|folder of 16-bit images in millimetres; without it, points are triangulated}"
            "{refine-poses||let the bundle adjustment of triangulated points move the poses}"
            "{features|iib|iib, or for comparisons: own (ORB's and AKAZE's descriptors) or sift}"
            "{out|<none>|the map, a folder; an older map there is replaced}",
            run);
}
