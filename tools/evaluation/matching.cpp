// SPDX-License-Identifier: Apache-2.0

#include "experiments.hpp"
#include "opencv2/core/utility.hpp"
#include "opencv2/iib.hpp"
#include "results.hpp"
#include "seeded.hpp"

namespace iib_tools {
namespace {

using cv::iib::HierarchicalMatcher;

const int ROUNDS = 5;  // of timing; the fastest counts

struct Matcher
{
    std::string name;
    cv::Ptr<cv::DescriptorMatcher> matcher;
};

//! Brute force, the module's modes, and the thresholds of the paper's figure as shares of each level's bits.
std::vector<Matcher> matchers(const std::vector<int>& levels)
{
    std::vector<Matcher> all = {{"BFMatcher", cv::BFMatcher::create(cv::NORM_HAMMING, true)},
            {"EXACT", HierarchicalMatcher::create(levels, HierarchicalMatcher::EXACT, 0, true)},
            {"ADAPTIVE", HierarchicalMatcher::create(levels, HierarchicalMatcher::ADAPTIVE, 0, true)}};
    for (int percent = 20; percent <= 50; percent += 5)
        all.push_back({cv::format("H-t-0.%02d", percent),
                HierarchicalMatcher::create(
                        levels, HierarchicalMatcher::THRESHOLD, float(percent) / 100, true)});
    return all;
}

//! Milliseconds of one call of each matcher; they take turns.
std::vector<double> times(const std::vector<Matcher>& all, const cv::Mat& query, const cv::Mat& train)
{
    std::vector<double> least(all.size(), DBL_MAX);
    std::vector<cv::DMatch> matches;
    for (int round = 0; round < ROUNDS; round++)
        for (size_t i = 0; i < all.size(); i++)
        {
            cv::TickMeter meter;
            meter.start();
            all[i].matcher->match(query, train, matches);
            meter.stop();
            least[i] = std::min(least[i], meter.getTimeMilli());
        }
    return least;
}

void evaluatePair(const Options& options, const ImagePair& pair, ResultTable& table)
{
    const Configuration iib = iibConfigurations().front();
    const LoadedPair loaded = loadPair(pair);
    const SeedPoints seeds =
            SeedSource(loaded.reference, options.points).seeds(iib, loaded.target.size(), loaded.homography);
    if (seeds.reference.empty())
        CV_Error(cv::Error::StsError, "no keypoints in " + pair.referenceFile);
    std::vector<cv::KeyPoint> ofReference = seeds.reference, ofTarget = seeds.target;
    const cv::Mat query = describe(iib, loaded.reference, {}, ofReference),
                  train = describe(iib, loaded.target, {}, ofTarget);
    const std::vector<Matcher> all = matchers(iib.create().dynamicCast<cv::iib::IIB>()->levelSizes());
    const std::vector<double> milliseconds = times(all, query, train);
    for (size_t i = 0; i < all.size(); i++)
    {
        const cv::Ptr<HierarchicalMatcher> ours = all[i].matcher.dynamicCast<HierarchicalMatcher>();
        if (ours)
            ours->resetCost();
        std::vector<cv::DMatch> matches;
        all[i].matcher->match(query, train, matches);
        const Counts counts = countsOf(
                correctByLocation(matches, ofReference, ofTarget, loaded.homography, options.tolerance),
                int(seeds.reference.size()));
        table.append(with(withCounts(with(pair.key(), all[i].name, pair.kind), counts),
                ours ? ours->matchCost() : 1., milliseconds[i]));
    }
}

}  // namespace

int matching(const Options& options, const std::vector<ImagePair>& pairs)
{
    Experiment experiment(options.out, "matching",
            {"set", "sequence", "target", "matcher", "kind", "correct", "putative", "correspondences",
                    "precision", "recall", "cost", "milliseconds"},
            4);
    for (const ImagePair& pair : pairs)
        if (pair.kind == "light")
            experiment.plan(with(pair.key(), "H-t-0.50"), pair.name(),
                    [&, pair] { evaluatePair(options, pair, experiment.table); });
    return experiment.run();
}

}  // namespace iib_tools
