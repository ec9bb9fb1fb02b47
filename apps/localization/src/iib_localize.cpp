// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include <filesystem>
#include <iostream>

#include "common/command_line.hpp"
#include "images.hpp"
#include "localizer.hpp"
#include "opencv2/imgcodecs.hpp"
#include "text_file.hpp"
#include "trajectory.hpp"

namespace {
using namespace iib_localization;

std::string csvHeader()
{
    std::string header = "name,found,reason,matches,inliers,bound_m,bound_deg";
    for (const std::string& stage : Location::stages())
        header += "," + stage + "_ms";
    return header + "\n";
}

std::string csvRow(const std::string& name, const Location& location)
{
    std::string row =
            cv::format("%s,%d,%s,%d,%d,%.4f,%.4f", name.c_str(), location.found, location.reason.c_str(),
                    int(location.matches), int(location.inliers.size()), location.metres, location.degrees);
    for (size_t i = 0; i < Location::stages().size(); i++)
        row += i < location.times.size() ? cv::format(",%.2f", location.times[i]) : ",";
    return row + "\n";
}

int run(const iib_tools::CommandLine& line)
{
    for (const char* needed : {"map", "images", "cameras", "out"})
        if (!line.has(needed))
            CV_Error(cv::Error::StsBadArg, cv::format("--%s is needed (--help tells more)", needed));
    const Cameras cameras = readCameras(line.text("cameras"));
    if (cameras.size() != 1)
        CV_Error(cv::Error::StsBadArg, line.text("cameras") + " must have one camera, that of all images");
    const std::vector<ImageFile> images = listImages(line.text("images"));
    const std::vector<NamedPose> priors =
            line.has("prior") ? readTrajectory(line.text("prior")) : std::vector<NamedPose>();
    const Map map = readMap(line.text("map"));
    const Localizer localizer(map, cameras.begin()->second);

    const std::string out = line.text("out");
    std::error_code error;
    std::filesystem::create_directories(out, error);
    std::ofstream frames = createFile(out + "/frames.csv");
    frames << csvHeader();
    std::vector<NamedPose> trajectory;
    for (const ImageFile& image : images)
    {
        const Location location =
                localizer.locate(cv::imread(image.path, cv::IMREAD_GRAYSCALE), findPose(priors, image.name));
        frames << csvRow(image.name, location);
        if (location.found)
            trajectory.push_back({image.name, location.estimate.pose});
    }
    finishFile(frames, out + "/frames.csv");
    writeTrajectory(out + "/trajectory.txt", trajectory);
    std::cout << trajectory.size() << " of " << images.size() << " images have a pose\n";
    return 0;
}

}  // namespace

int main(int argc, char** argv)
{
    return iib_tools::runTool(argc, argv,
            "Finds where images were taken, in a map that iib_map made.\n"
            "  iib_localize --map MAP --images DIR --cameras cameras.txt --out OUT\n"
            "OUT/trajectory.txt has the poses (TUM's format), OUT/frames.csv what became of each image.",
            "{map|<none>|the map, a folder}"
            "{images|<none>|folder of the images}"
            "{cameras|<none>|COLMAP's cameras.txt with the camera of all images}"
            "{prior|<none>|TUM's poses: about where the images were taken}"
            "{out|<none>|folder for the results}",
            run);
}
