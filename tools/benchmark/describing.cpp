// SPDX-License-Identifier: Apache-2.0

#include "benchmark.hpp"

#include "evaluation/configurations.hpp"
#include "opencv2/core/utility.hpp"

using namespace cv;
using cv::iib::IIB;

namespace iib_tools {

Timed describing(const String& what, const String& name, double size, const Ptr<Feature2D>& feature,
        const Mat& image, const std::vector<KeyPoint>& given, int threads, const std::vector<Mat>& maps)
{
    const Ptr<IIB> iib = feature.dynamicCast<IIB>();
    std::vector<KeyPoint> keypoints;
    Mat descriptors;
    return {what, name, size, threads, 1, [=]() mutable {
                keypoints = given;
                if (iib)
                    iib->compute(image, maps, keypoints, descriptors);
                else
                    feature->compute(image, keypoints, descriptors);
            }};
}

std::vector<Timed> describingTasks()
{
    const Mat image = cornerImage(Size(1280, 720));
    const std::vector<KeyPoint> points[] = {corners(image, 1000), corners(image, 5000)};
    std::vector<Timed> tasks;
    const auto add = [&](const String& name, const Ptr<Feature2D>& feature, int threads = 1,
                             const std::vector<Mat>& maps = std::vector<Mat>()) {
        for (const std::vector<KeyPoint>& some : points)
            tasks.push_back(
                    describing("describe", name, double(some.size()), feature, image, some, threads, maps));
    };
    const int all = IIB::CHANNELS_DEFAULT, mean = IIB::MAPPING_MEAN;
    add("cv::ORB", ORB::create());
    add("default", IIB::create());
    add("granularity 5", IIB::create(2.f, 5));
    add("overlap", IIB::create(2.f, 4, all, mean, true));
    const std::vector<std::pair<const char*, int>> mappings = {{"MAX", IIB::MAPPING_MAX},
            {"QUARTILE", IIB::MAPPING_QUARTILE}, {"SORT", IIB::MAPPING_SORT}, {"HAAR", IIB::MAPPING_HAAR},
            {"PAIRWISE", IIB::MAPPING_PAIRWISE}};
    for (const auto& mapping : mappings)
        add(mapping.first, IIB::create(2.f, 4, all, mapping.second));
    const std::vector<std::pair<const char*, int>> presets = {{"COMPACT", IIB::PRESET_COMPACT},
            {"BALANCED", IIB::PRESET_BALANCED}, {"VIEWPOINT", IIB::PRESET_VIEWPOINT},
            {"UNIVERSAL", IIB::PRESET_UNIVERSAL}, {"SMALL", IIB::PRESET_SMALL}};
    for (const auto& preset : presets)
        add(String("PRESET_") + preset.first, IIB::createPreset(preset.second));
    add("2 extra channels", IIB::create(2.f, 4, all, mean, false, false, 2), 1, {image, image});
    add("useOrientation", IIB::create(2.f, 4, all, mean, false, true));
    add("default", IIB::create(), 2);
    for (const char* name : {"BEBLID-256", "BEBLID-512", "TEBLID-512", "LATCH-512"})
        for (const Configuration& c : baselineConfigurations())
            if (c.name == name)
                add(name, c.create());
    return tasks;
}

std::vector<Timed> pixelTasks()
{
    const Mat large = cornerImage(Size(6000, 4000));
    std::vector<Timed> tasks;
    for (double side : {0.125, 0.25, 0.375, 0.5, 0.75, 1.})
    {
        const Mat image = large(Rect(0, 0, cvRound(large.cols * side), cvRound(large.rows * side)));
        const std::vector<KeyPoint> scattered = corners(image, 1000);
        const double size = double(image.total()) * 1e-6;
        tasks.push_back(describing("megapixels", "default", size, IIB::create(), image, scattered));
        tasks.push_back(describing("megapixels", "cv::ORB", size, ORB::create(), image, scattered));
    }
    return tasks;
}

}  // namespace iib_tools
