// SPDX-License-Identifier: Apache-2.0

#include "seeded.hpp"

#include <algorithm>

#include "opencv2/iib.hpp"
#include "opencv2/imgproc.hpp"

namespace iib_tools {
namespace {

//! AKAZE and KAZE describe only points of their own scale space.
std::vector<cv::KeyPoint> detectSeeds(const std::string& name, const cv::Mat& image, int count)
{
    cv::Ptr<cv::Feature2D> detector;
    if (name == "AKAZE")
        detector = cv::AKAZE::create(cv::AKAZE::DESCRIPTOR_MLDB_UPRIGHT);
    else if (name == "KAZE")
        detector = cv::KAZE::create(false, true);
    else
        return fastCorners(image, SEED_RADIUS, count);
    std::vector<cv::KeyPoint> keypoints;
    detector->detect(image, keypoints);
    std::stable_sort(keypoints.begin(), keypoints.end(),
            [](const cv::KeyPoint& a, const cv::KeyPoint& b) { return a.pt.y < b.pt.y; });
    return keypoints;
}

/** Local binary patterns (Ojala, Pietikainen and Maenpaa 2002, radius 1), each by the number of its bits, so that means
of them say something: how many of the eight neighbours are no darker than the pixel. */
cv::Mat localBinaryPatterns(const cv::Mat& image)
{
    cv::Mat around, patterns = cv::Mat::zeros(image.size(), CV_8U);
    cv::copyMakeBorder(image, around, 1, 1, 1, 1, cv::BORDER_REFLECT_101);
    for (int y = 0; y < 3; y++)
        for (int x = 0; x < 3; x++)
            if (x != 1 || y != 1)
                patterns += (around(cv::Rect(x, y, image.cols, image.rows)) >= image) / 255;
    return patterns;
}

void matchSeeds(const Options& options, const LoadedPair& images,
        const std::vector<Configuration>& configurations, const Fields& key, ResultTable& table)
{
    SeedSource source(images.reference, options.points);
    for (const Configuration& c : configurations)
    {
        SeedPoints seeds = source.seeds(c, images.target.size(), images.homography);
        const int correspondences = int(seeds.reference.size());
        if (c.oriented)
        {
            orientByCentroid(images.reference, SEED_RADIUS, seeds.reference);
            orientByCentroid(images.target, SEED_RADIUS, seeds.target);
        }
        const cv::Mat reference = describe(c, images.reference, images.referenceExtra, seeds.reference),
                      target = describe(c, images.target, images.targetExtra, seeds.target);
        const cv::Ptr<cv::Feature2D> feature = c.create();
        const std::vector<bool> correct =
                correctByLocation(mutualMatches(reference, target, feature->defaultNorm()), seeds.reference,
                        seeds.target, images.homography, options.tolerance);
        Fields row = key;
        row.insert(row.end(), {c.name, std::to_string(descriptorBytes(*feature))});
        table.append(withCounts(row, countsOf(correct, correspondences)));
    }
}

}  // namespace

cv::Mat describe(const Configuration& configuration, const cv::Mat& image,
        const std::map<std::string, cv::Mat>& maps, std::vector<cv::KeyPoint>& points)
{
    std::vector<cv::Mat> extras;
    for (const std::string& name : configuration.extraNames)
        extras.push_back(name == TEXTURE ? localBinaryPatterns(image) : maps.at(name));
    cv::Mat descriptors;
    const cv::Ptr<cv::Feature2D> feature = configuration.create();
    if (extras.empty())
        feature->compute(image, points, descriptors);
    else
        feature.dynamicCast<cv::iib::IIB>()->compute(image, extras, points, descriptors);
    return descriptors;
}

SeedPoints SeedSource::seeds(
        const Configuration& configuration, cv::Size targetSize, const cv::Matx33d& homography)
{
    auto found = points_.find(configuration.seeds);
    if (found == points_.end())
        found = points_.emplace(configuration.seeds, detectSeeds(configuration.seeds, reference_, count_))
                        .first;
    std::vector<cv::KeyPoint> points = found->second;
    if (configuration.seedSize > 0)
        for (cv::KeyPoint& point : points)
            point.size = configuration.seedSize;
    return projectSeeds(points, homography, reference_.size(), targetSize, SEED_RADIUS, count_);
}

Fields seededColumns()
{
    return {"set", "sequence", "target", "kind", "configuration", "bytes", "correct", "putative",
            "correspondences", "precision", "recall"};
}

void addSeededTask(const Options& options, const Fields& key,
        const std::vector<Configuration>& configurations, const std::function<LoadedPair()>& load,
        ResultTable& table, std::vector<Task>& tasks)
{
    std::vector<Configuration> missing;
    for (const Configuration& c : configurations)
    {
        Fields row = key;
        row.push_back(c.name);
        if (!table.has(row))
            missing.push_back(c);
    }
    if (!missing.empty())
        tasks.push_back({key[0] + "/" + key[1] + "/" + key[2], [&options, &table, key, load, missing] {
                             matchSeeds(options, load(), missing, key, table);
                         }});
}

}  // namespace iib_tools
