// SPDX-License-Identifier: Apache-2.0

#include "seeded.hpp"

#include <algorithm>
#include <iterator>
#include <set>

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

/** Local binary patterns (Ojala, Pietikainen and Maenpaa 2002, radius 1): the number of the eight neighbours that are no darker than
the pixel. Unlike the patterns' bits, this number has a meaningful mean. */
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
        table.append(
                withCounts(with(key, c.name, descriptorBytes(*feature)), countsOf(correct, correspondences)));
    }
}

/** Plans a row with the mutual matches at the seeds, for each configuration without one. Every seed is a correspondence, even if the
descriptor dropped it.
@param key set, sequence, target and kind. @param load reads the images. */
void planSeeded(const Options& options, const Fields& key, const std::vector<Configuration>& configurations,
        const std::function<LoadedPair()>& load, Experiment& experiment)
{
    std::vector<Configuration> missing;
    std::copy_if(configurations.begin(), configurations.end(), std::back_inserter(missing),
            [&](const Configuration& c) { return !experiment.table.has(with(key, c.name)); });
    if (!missing.empty())
        experiment.plan(
                {}, key[0] + "/" + key[1] + "/" + key[2], [&options, &experiment, key, load, missing] {
                    matchSeeds(options, load(), missing, key, experiment.table);
                });
}

bool hasExtras(const Configuration& configuration, const ImagePair& pair)
{
    for (const std::string& wanted : configuration.extraNames)
        if (wanted != TEXTURE &&
                std::find(pair.extraNames.begin(), pair.extraNames.end(), wanted) == pair.extraNames.end())
            return false;
    return true;
}

//! A rotation or scaling of the reference about its centre.
struct Warp
{
    std::string kind;
    double amount;  //!< degrees, or factor
};

std::vector<Warp> warps()
{
    std::vector<Warp> all;
    for (int degrees : {5, 10, 15, 30, 45, 90, 135, 180})
        all.push_back({"turn", double(degrees)});
    for (double factor : {0.5, 0.7, 0.85, 1.2, 1.4, 2.0})
        all.push_back({"scale", factor});
    return all;
}

LoadedPair warpedPair(const cv::Mat& reference, const Warp& warp)
{
    const cv::Point2f centre(float(reference.cols - 1) / 2, float(reference.rows - 1) / 2);
    const bool turn = warp.kind == "turn";
    const cv::Mat affine = cv::getRotationMatrix2D(centre, turn ? warp.amount : 0, turn ? 1 : warp.amount);
    LoadedPair pair;
    pair.reference = reference;
    // Smaller images are averaged, larger ones interpolated, as a camera's lens and sensor would do.
    cv::Mat source = reference;
    if (!turn && warp.amount < 1)
        cv::GaussianBlur(reference, source, cv::Size(), 0.5 / warp.amount);
    cv::warpAffine(source, pair.target, affine, reference.size(), cv::INTER_CUBIC, cv::BORDER_REFLECT_101);
    pair.homography = cv::Matx33d::eye();
    for (int y = 0; y < 2; y++)
        for (int x = 0; x < 3; x++)
            pair.homography(y, x) = affine.at<double>(y, x);
    return pair;
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

int fixedPoints(const Options& options, const std::vector<ImagePair>& pairs)
{
    std::vector<Configuration> all = iibConfigurations();
    for (const std::string& file : options.saved)
        all.push_back(savedConfiguration(file));
    for (const Configuration& baseline : baselineConfigurations())
        all.push_back(baseline);
    Experiment experiment(options.out, "fixed_points", seededColumns(), 5);
    for (const ImagePair& pair : pairs)
    {
        std::vector<Configuration> possible;
        std::copy_if(all.begin(), all.end(), std::back_inserter(possible),
                [&](const Configuration& c) { return hasExtras(c, pair); });
        planSeeded(
                options, with(pair.key(), pair.kind), possible, [pair] { return loadPair(pair); },
                experiment);
    }
    return experiment.run();
}

int robustness(const Options& options, const std::vector<ImagePair>& pairs)
{
    Experiment experiment(options.out, "robustness", seededColumns(), 5);
    std::set<std::string> turned;  // one sequence a set
    for (const ImagePair& pair : pairs)
        if (turned.insert(pair.set).second)
            for (const Warp& warp : warps())
                planSeeded(
                        options, {pair.set, pair.sequence, text(warp.amount), warp.kind},
                        robustnessConfigurations(),
                        [pair, warp] { return warpedPair(loadPair(pair).reference, warp); }, experiment);
    return experiment.run();
}

}  // namespace iib_tools
