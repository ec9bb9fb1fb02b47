// SPDX-License-Identifier: Apache-2.0

#include <algorithm>

#include "experiments.hpp"
#include "opencv2/imgcodecs.hpp"
#include "results.hpp"
#include "seeded.hpp"
#include "tasks.hpp"

namespace iib_tools {
namespace {

const int REPETITIONS = 40;
const int FEWEST = 3;    // for descriptors that take longer than
const double SLOW = 50;  // milliseconds
const int MORE = 5;      // times as many keypoints, for the cost of a further one

struct Subject
{
    Configuration configuration;
    std::vector<cv::KeyPoint> keypoints;
    std::vector<double> few, many;  // milliseconds
};

double milliseconds(const Configuration& configuration, const cv::Mat& image,
        std::vector<cv::KeyPoint> keypoints, int count)
{
    keypoints.resize(std::min(keypoints.size(), size_t(count)));
    const cv::Ptr<cv::Feature2D> feature = configuration.create();
    cv::Mat descriptors;
    const int64 start = cv::getTickCount();
    feature->compute(image, keypoints, descriptors);
    return double(cv::getTickCount() - start) / cv::getTickFrequency() * 1e3;
}

cv::Mat largestReference(const std::vector<ImagePair>& pairs)
{
    cv::Mat largest;
    for (const ImagePair& pair : pairs)
    {
        const cv::Mat image = readImage(pair.referenceFile, cv::IMREAD_GRAYSCALE);
        if (image.total() > largest.total())
            largest = image;
    }
    return largest;
}

//! The least disturbed of the repetitions.
double least(const std::vector<double>& values) { return *std::min_element(values.begin(), values.end()); }

void measure(
        const cv::Mat& image, int count, const std::vector<Configuration>& configurations, ResultTable& table)
{
    SeedSource source(image, MORE * count);
    std::vector<Subject> subjects;
    for (const Configuration& c : configurations)
    {
        Subject s;
        s.configuration = c;
        s.keypoints = source.seeds(c, image.size(), cv::Matx33d::eye()).reference;
        subjects.push_back(s);
    }
    // Interleaved, so that a busy machine is busy for all of them.
    for (int repetition = 0; repetition < REPETITIONS; repetition++)
        for (Subject& s : subjects)
        {
            if (repetition >= FEWEST && s.few.front() > SLOW)
                continue;
            s.few.push_back(milliseconds(s.configuration, image, s.keypoints, count));
            s.many.push_back(milliseconds(s.configuration, image, s.keypoints, MORE * count));
        }
    for (const Subject& s : subjects)
    {
        const int few = std::min(int(s.keypoints.size()), count);
        const int more = int(s.keypoints.size()) - few;
        table.append({s.configuration.name, std::to_string(descriptorBytes(*s.configuration.create())),
                std::to_string(image.cols) + "x" + std::to_string(image.rows), std::to_string(few),
                text(least(s.few)), more > 0 ? text((least(s.many) - least(s.few)) / more * 1e3) : ""});
    }
}

}  // namespace

int cost(const Options& options, const std::vector<ImagePair>& pairs)
{
    std::vector<Configuration> all;
    for (const Configuration& c : iibConfigurations())
        if (c.extraNames.empty() && c.seeds == "FAST")
            all.push_back(c);
    for (const Configuration& baseline : baselineConfigurations())
        all.push_back(baseline);
    ResultTable table(options.out + "/cost.csv",
            {"configuration", "bytes", "image", "keypoints", "milliseconds",
                    "microseconds_per_further_keypoint"},
            1);
    bool complete = true;
    for (const Configuration& c : all)
        complete = complete && table.has({c.name});
    if (complete || pairs.empty())
        return 0;

    const int threads = cv::getNumThreads();
    cv::setNumThreads(1);
    const int skipped = runTasks("cost",
            {{"largest image", [&] { measure(largestReference(pairs), options.points, all, table); }}});
    cv::setNumThreads(threads);
    table.finish();
    return skipped;
}

}  // namespace iib_tools
