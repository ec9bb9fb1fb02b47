// SPDX-License-Identifier: Apache-2.0

#include <algorithm>
#include <iostream>

#include "../src/images.hpp"
#include "../src/localizer.hpp"
#include "common/command_line.hpp"
#include "opencv2/imgcodecs.hpp"

// Localizes the same images in a map and in larger ones, simulated by keyframes that show other places: each byte of their
// codes is that byte of some code of the map, so that bits are as frequent as in the map.
namespace {
using namespace iib_localization;

constexpr int CODES = 400;  // a simulated keyframe and detector

cv::Mat otherCodes(const std::vector<cv::Mat>& real, cv::RNG& random)
{
    cv::Mat codes(CODES, real[0].cols, CV_8U);
    for (int row = 0; row < codes.rows; row++)
        for (int column = 0; column < codes.cols; column++)
        {
            const cv::Mat& keyframe = real[size_t(random.uniform(0, int(real.size())))];
            codes.at<uchar>(row, column) = keyframe.at<uchar>(random.uniform(0, keyframe.rows), column);
        }
    return codes;
}

void grow(Map& map, size_t keyframes, const std::vector<std::vector<cv::Mat>>& real, cv::RNG& random)
{
    while (map.codes.size() < keyframes)
    {
        Keyframe keyframe = map.model.keyframes[0];
        keyframe.points.assign(CODES * real.size(), 0);
        keyframe.pixels.clear();
        map.model.keyframes.push_back(keyframe);
        map.codes.emplace_back();
        for (const std::vector<cv::Mat>& detector : real)
            map.codes.back().push_back(otherCodes(detector, random));
    }
}

double median(std::vector<double> values)
{
    std::nth_element(values.begin(), values.begin() + std::ptrdiff_t(values.size() / 2), values.end());
    return values[values.size() / 2];
}

int run(const iib_tools::CommandLine& line)
{
    for (const char* needed : {"map", "images", "cameras"})
        if (!line.has(needed))
            CV_Error(cv::Error::StsBadArg, cv::format("--%s is needed (--help tells more)", needed));
    Map map = readMap(line.text("map"));
    std::vector<std::vector<cv::Mat>> real(map.codes.at(0).size());  // [detector][keyframe]
    for (const std::vector<cv::Mat>& keyframe : map.codes)
        for (size_t d = 0; d < real.size(); d++)
            if (!keyframe[d].empty())
                real[d].push_back(keyframe[d]);
    const Camera camera = readCameras(line.text("cameras")).begin()->second;
    std::vector<cv::Mat> images;
    for (const ImageFile& image : listImages(line.text("images")))
        images.push_back(cv::imread(image.path, cv::IMREAD_GRAYSCALE));

    std::cout << "keyframes,images,found,retrieval_bytes_a_keyframe";
    for (const std::string& stage : Location::stages())
        std::cout << "," << stage << "_ms";
    std::cout << "\n";
    cv::RNG random(1);
    for (const size_t keyframes : {map.codes.size(), size_t(100), size_t(1000), size_t(10000)})
    {
        grow(map, keyframes, real, random);
        const Localizer localizer(map, camera);
        size_t found = 0;
        std::vector<std::vector<double>> times(Location::stages().size());
        for (const cv::Mat& image : images)
        {
            const Location location = localizer.locate(image);
            found += location.found ? 1 : 0;
            for (size_t stage = 0; stage < location.times.size(); stage++)
                times[stage].push_back(location.times[stage]);
        }
        std::cout << map.codes.size() << "," << images.size() << "," << found << ","
                  << localizer.retrievalBytes() / map.codes.size();
        for (const std::vector<double>& stage : times)
            std::cout << cv::format(",%.1f", stage.empty() ? 0. : median(stage));
        std::cout << std::endl;
    }
    return 0;
}

}  // namespace

int main(int argc, char** argv)
{
    return iib_tools::runTool(argc, argv,
            "Localizes images in a map and in larger ones with simulated keyframes; prints CSV.\n"
            "  iib_map_growth --map MAP --images DIR --cameras cameras.txt",
            "{map|<none>|the map, a folder; its codes must be binary}"
            "{images|<none>|folder of the images}"
            "{cameras|<none>|COLMAP's cameras.txt with the camera of all images}",
            run);
}
