// SPDX-License-Identifier: Apache-2.0

#include "benchmark.hpp"

#include "evaluation/configurations.hpp"
#include "opencv2/core/utility.hpp"

using namespace cv;
using cv::iib::IIB;

namespace iib_tools {
namespace {

struct Row
{
    String name;
    Ptr<Feature2D> feature;
    std::vector<Mat> extraChannels;
    int threads;
};

std::vector<Row> allRows(const Mat& image)
{
    const int all = IIB::CHANNELS_DEFAULT, mean = IIB::MAPPING_MEAN;
    std::vector<Row> rows = {{"cv::ORB", ORB::create(), {}, 1}, {"default", IIB::create(), {}, 1},
            {"granularity 5", IIB::create(2.f, 5), {}, 1},
            {"overlap", IIB::create(2.f, 4, all, mean, true), {}, 1}};
    const std::vector<std::pair<const char*, int>> mappings = {{"MAX", IIB::MAPPING_MAX},
            {"QUARTILE", IIB::MAPPING_QUARTILE}, {"SORT", IIB::MAPPING_SORT}, {"HAAR", IIB::MAPPING_HAAR},
            {"PAIRWISE", IIB::MAPPING_PAIRWISE}};
    for (const auto& mapping : mappings)
        rows.push_back({mapping.first, IIB::create(2.f, 4, all, mapping.second), {}, 1});
    const std::vector<std::pair<const char*, int>> presets = {{"COMPACT", IIB::PRESET_COMPACT},
            {"BALANCED", IIB::PRESET_BALANCED}, {"VIEWPOINT", IIB::PRESET_VIEWPOINT},
            {"UNIVERSAL", IIB::PRESET_UNIVERSAL}, {"SMALL", IIB::PRESET_SMALL}};
    for (const auto& preset : presets)
        rows.push_back({String("PRESET_") + preset.first, IIB::createPreset(preset.second), {}, 1});
    rows.push_back({"2 extra channels", IIB::create(2.f, 4, all, mean, false, false, 2), {image, image}, 1});
    rows.push_back({"useOrientation", IIB::create(2.f, 4, all, mean, false, true), {}, 1});
    rows.push_back({"default, 2 threads", IIB::create(), {}, 2});
    for (const char* name : {"BEBLID-256", "BEBLID-512", "TEBLID-512", "LATCH-512"})
        for (const Configuration& c : baselineConfigurations())
            if (c.name == name)
                rows.push_back({name, c.create(), {}, 1});
    return rows;
}

}  // namespace

void measureDescribing(FileStorage& fs, int rounds)
{
    const Size size(1280, 720);
    const int counts[] = {1000, 5000};
    const Mat image = cornerImage(size);
    const std::vector<Row> rows = allRows(image);
    std::vector<KeyPoint> keypoints;
    Mat descriptors;
    std::vector<Timed> tasks;
    for (const Row& row : rows)
        for (int count : counts)
        {
            const std::vector<KeyPoint> chosen = corners(image, count);
            CV_Assert((int)chosen.size() == count);
            const Ptr<IIB> iib = row.feature.dynamicCast<IIB>();
            tasks.push_back({[&, chosen, iib] {
                                 keypoints = chosen;
                                 if (iib)
                                     iib->compute(image, row.extraChannels, keypoints, descriptors);
                                 else
                                     row.feature->compute(image, keypoints, descriptors);
                             },
                    row.threads, 1});
        }
    const std::vector<double> milliseconds = measure(tasks, rounds);
    fs << "width" << size.width << "height" << size.height << "keypoints"
       << "[" << counts[0] << counts[1] << "]"
       << "rows"
       << "[";
    for (size_t i = 0; i < rows.size(); i++)
        fs << "{"
           << "name" << rows[i].name << "threads" << rows[i].threads << "milliseconds"
           << "[" << milliseconds[2 * i] << milliseconds[2 * i + 1] << "]"
           << "}";
    fs << "]";
}

void measurePixels(FileStorage& fs, int rounds)
{
    const Mat large = cornerImage(Size(6000, 4000));
    const Ptr<Feature2D> features[] = {IIB::create(), ORB::create()};
    std::vector<Mat> images;
    std::vector<KeyPoint> keypoints;
    Mat descriptors;
    std::vector<Timed> tasks;
    for (double side : {0.125, 0.25, 0.375, 0.5, 0.75, 1.})
    {
        const Mat image = large(Rect(0, 0, cvRound(large.cols * side), cvRound(large.rows * side)));
        const std::vector<KeyPoint> scattered = corners(image, 1000);
        images.push_back(image);
        for (const Ptr<Feature2D>& feature : features)
            tasks.push_back({[&, image, scattered, feature] {
                                 keypoints = scattered;
                                 feature->compute(image, keypoints, descriptors);
                             },
                    1, 1});
    }
    const std::vector<double> milliseconds = measure(tasks, rounds);
    fs << "pixels"
       << "[";
    for (size_t i = 0; i < images.size(); i++)
        fs << "{"
           << "megapixels" << images[i].total() * 1e-6 << "keypoints" << 1000 << "milliseconds"
           << milliseconds[2 * i] << "orb_milliseconds" << milliseconds[2 * i + 1] << "}";
    fs << "]";
}

}  // namespace iib_tools
