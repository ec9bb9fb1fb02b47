// SPDX-License-Identifier: Apache-2.0

#include "seeded.hpp"

#include <algorithm>

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

}  // namespace

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

SeededMatches matchSeeds(const Configuration& configuration, const SeededPair& pair, double tolerance)
{
    SeedPoints seeds = pair.seeds;
    if (configuration.oriented)
    {
        orientByCentroid(pair.reference, SEED_RADIUS, seeds.reference);
        orientByCentroid(pair.target, SEED_RADIUS, seeds.target);
    }
    SeededMatches m;
    m.reference = describe(configuration, pair.reference, pair.referenceExtra, seeds.reference);
    m.target = describe(configuration, pair.target, pair.targetExtra, seeds.target);
    m.matches = mutualMatches(
            m.reference.descriptors, m.target.descriptors, configuration.create()->defaultNorm());
    m.correct = correctByLocation(
            m.matches, m.reference.keypoints, m.target.keypoints, pair.homography, tolerance);
    m.counts = countsOf(m.correct, int(pair.seeds.reference.size()));
    return m;
}

}  // namespace iib_tools
