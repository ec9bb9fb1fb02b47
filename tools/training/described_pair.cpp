// SPDX-License-Identifier: Apache-2.0

#include "samples.hpp"

#include <algorithm>
#include <set>
#include <tuple>

#include "common/keypoints.hpp"
#include "common/metrics.hpp"
#include "opencv2/iib.hpp"

namespace iib_tools {
namespace {

const float RADIUS = 32;
const int POINTS = 1000;
const float RATIO = 0.9f;                      // of the recommended matcher, for detected points
const double SAME_PLACE = 2, SAME_SIZE = 1.5;  // pixels; ratio

cv::KeyPoint projected(const Sample& sample, cv::KeyPoint point)
{
    if (sample.relief)
        point = sample.relief->project(point);
    point.size *= float(localScale(sample.pair.homography, point.pt));
    point.pt = project(sample.pair.homography, point.pt);
    return point;
}

//! Pairs of rows in reference and target, nearest first; each row is used once.
std::vector<std::pair<int, int>> partnersAmong(
        const std::vector<cv::KeyPoint>& reference, const std::vector<cv::KeyPoint>& target)
{
    std::vector<std::tuple<double, int, int>> candidates;
    for (size_t i = 0; i < reference.size(); i++)
        for (size_t k = 0; k < target.size(); k++)
        {
            const double distance = cv::norm(reference[i].pt - target[k].pt),
                         ratio = reference[i].size / target[k].size;
            if (distance <= SAME_PLACE && ratio <= SAME_SIZE && ratio * SAME_SIZE >= 1)
                candidates.push_back(std::make_tuple(distance, int(i), int(k)));
        }
    std::sort(candidates.begin(), candidates.end());
    std::set<int> used[2];
    std::vector<std::pair<int, int>> partners;
    for (const auto& candidate : candidates)
    {
        const int i = std::get<1>(candidate), k = std::get<2>(candidate);
        if (used[0].count(i) + used[1].count(k) > 0)
            continue;
        used[0].insert(i);
        used[1].insert(k);
        partners.push_back(std::make_pair(i, k));
    }
    return partners;
}

//! The chosen keypoints first, then the others.
std::vector<int> withFirst(const std::vector<int>& chosen, size_t count)
{
    std::vector<int> order = chosen;
    const std::set<int> first(chosen.begin(), chosen.end());
    for (int i = 0; i < int(count); i++)
        if (!first.count(i))
            order.push_back(i);
    return order;
}

std::vector<cv::KeyPoint> inOrder(const std::vector<cv::KeyPoint>& keypoints, const std::vector<int>& order)
{
    std::vector<cv::KeyPoint> result;
    for (int i : order)
        result.push_back(keypoints[i]);
    return result;
}

}  // namespace

DescribedPair describeFixed(
        const std::string& scene, const LoadedPair& pair, const cv::Ptr<cv::Feature2D>& extractor)
{
    SeedPoints seeds = fastSeeds(pair.reference, pair.target, pair.homography, RADIUS, POINTS);
    DescribedPair described;
    described.scene = scene;
    described.ratio = 1;
    described.partners = int(seeds.target.size());
    cv::KeyPoint::convert(seeds.target, described.targetPoints);
    described.referencePoints = described.targetPoints;
    extractor->compute(pair.reference, seeds.reference, described.reference);
    extractor->compute(pair.target, seeds.target, described.target);
    return described;
}

DescribedPair describeDetected(
        const std::string& scene, const Sample& sample, const cv::Ptr<cv::Feature2D>& extractor)
{
    const cv::Ptr<cv::Feature2D> detector = cv::iib::HessianDetector::create(POINTS);
    const float scaleFactor = cv::iib::IIB::scaleFactorFor(detector);
    std::vector<cv::KeyPoint> found[2], seen;
    const cv::Mat images[2] = {sample.pair.reference, sample.pair.target};
    for (int i = 0; i < 2; i++)
        detector->detect(images[i], found[i]);
    for (const cv::KeyPoint& point : found[0])
        seen.push_back(projected(sample, point));
    std::vector<int> first[2];
    for (const auto& partners : partnersAmong(seen, found[1]))
    {
        first[0].push_back(partners.first);
        first[1].push_back(partners.second);
    }

    DescribedPair described;
    described.scene = scene;
    described.ratio = RATIO;
    described.partners = int(first[0].size());
    cv::Mat* const rows[2] = {&described.reference, &described.target};
    for (int i = 0; i < 2; i++)
    {
        const std::vector<int> order = withFirst(first[i], found[i].size());
        cv::KeyPoint::convert(inOrder(i == 0 ? seen : found[i], order),
                i == 0 ? described.referencePoints : described.targetPoints);
        found[i] = inOrder(found[i], order);
        for (cv::KeyPoint& point : found[i])
            point.size *= scaleFactor;
        extractor->compute(images[i], found[i], *rows[i]);
    }
    return described;
}

}  // namespace iib_tools
