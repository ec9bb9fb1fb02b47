// SPDX-License-Identifier: Apache-2.0

#include <filesystem>

#include "../src/localizer.hpp"
#include "../src/map_builder.hpp"
#include "../src/trajectory.hpp"
#include "common/test/test_folder.hpp"
#include "opencv2/imgcodecs.hpp"
#include "opencv2/imgproc.hpp"

namespace {
using namespace iib_localization;

//! Darkened by gamma 2.2, a ramp to a quarter across the image, half the light, and noise.
cv::Mat relit(const cv::Mat& grey)
{
    cv::Mat light, noise(grey.size(), CV_32F), result;
    grey.convertTo(light, CV_32F, 1 / 255.);
    cv::pow(light, 2.2, light);
    for (int x = 0; x < light.cols; x++)
        light.col(x) *= 0.5 * (1 - 0.75 * x / (light.cols - 1));
    cv::RNG(1).fill(noise, cv::RNG::NORMAL, 0, 2);
    light = light * 255 + noise;
    light.convertTo(result, CV_8U);
    return result;
}

// Strecha's photographs (CVPR 2008): the map of every other image, triangulated, and all others found in it.
TEST(Photographs, within_five_centimetres_also_relit)
{
    const char* data = std::getenv("OPENCV_TEST_DATA_PATH");
    const std::string folder = std::string(data ? data : "") + "/strecha/Herz-Jesus-P8";
    if (!std::filesystem::exists(folder))
    {
        std::cout << "skipped: OPENCV_TEST_DATA_PATH has no strecha/Herz-Jesus-P8\n";
        return;
    }
    const std::vector<NamedPose> poses = readTrajectory(folder + "/poses.txt");
    std::vector<NamedPose> mapped, others;
    for (size_t i = 0; i < poses.size(); i++)
        (i % 2 == 0 ? mapped : others).push_back(poses[i]);
    const TestFolder work;
    writeTrajectory(work.path("poses.txt"), mapped);
    MapSources sources;
    sources.images = folder + "/images";
    sources.cameras = folder + "/cameras.txt";
    sources.poses = work.path("poses.txt");
    const Map map = buildMap(sources);
    EXPECT_EQ(mapped.size(), map.model.keyframes.size());

    const Localizer localizer(map, readCameras(sources.cameras).begin()->second);
    for (const NamedPose& other : others)
    {
        std::vector<cv::String> files;
        cv::glob(folder + "/images/" + other.name + ".*", files);
        ASSERT_EQ(1u, files.size());
        const cv::Mat grey = cv::imread(files[0], cv::IMREAD_GRAYSCALE);
        for (const cv::Mat& image : {grey, relit(grey)})
        {
            const Location location = localizer.locate(image);
            ASSERT_TRUE(location.found) << other.name << ": " << location.reason;
            EXPECT_LT((location.estimate.pose.position - other.pose.position).norm(), 0.05) << other.name;
            EXPECT_LT(
                    location.estimate.pose.rotation.angularDistance(other.pose.rotation), 0.5 * CV_PI / 180);
        }
    }
}

}  // namespace
