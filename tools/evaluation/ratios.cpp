// SPDX-License-Identifier: Apache-2.0

#include "common/metrics.hpp"
#include "configurations.hpp"
#include "experiments.hpp"
#include "opencv2/iib.hpp"
#include "results.hpp"
#include "tasks.hpp"

namespace iib_tools {
namespace {

using cv::iib::IIB;

const float RATIOS[] = {1, 0.7f, 0.75f, 0.8f, 0.85f, 0.9f, 0.95f};  // 1: mutual matches and no ratio test

std::string ruleName(float ratio) { return ratio == 1 ? std::string("mutual") : cv::format("%g", ratio); }

void evaluatePair(const Options& options, const ImagePair& pair,
        const std::vector<Configuration>& configurations, ResultTable& table)
{
    const LoadedPair loaded = loadPair(pair);
    const cv::Mat images[] = {loaded.reference, loaded.target};
    std::vector<cv::KeyPoint> keypoints[2];
    for (int i = 0; i < 2; i++)
    {
        cv::AKAZE::create()->detect(images[i], keypoints[i]);
        cv::KeyPointsFilter::retainBest(keypoints[i], options.points);
    }
    for (const Configuration& c : configurations)
    {
        const cv::Ptr<IIB> iib = c.create().dynamicCast<IIB>();
        iib->setScaleFactor(iib->getScaleFactor() * IIB::scaleFactorFor("AKAZE"));
        cv::Mat codes[2];
        for (int i = 0; i < 2; i++)
            iib->cv::Feature2D::compute(images[i], keypoints[i], codes[i]);
        const cv::Ptr<cv::iib::HierarchicalMatcher> matcher =
                cv::iib::HierarchicalMatcher::create(iib->levelSizes());
        for (float ratio : RATIOS)
        {
            std::vector<cv::DMatch> matches;
            matcher->setMaxRatio(ratio);
            matcher->setCrossCheck(ratio == 1);
            matcher->match(codes[0], codes[1], matches);
            const Counts n = countsOf(correctByLocation(matches, keypoints[0], keypoints[1],
                                              loaded.homography, options.tolerance),
                    0);
            table.append({pair.set, pair.sequence, pair.target, pair.kind, c.name, ruleName(ratio),
                    std::to_string(n.correct), std::to_string(n.putative)});
        }
    }
}

}  // namespace

int ratios(const Options& options, const std::vector<ImagePair>& pairs)
{
    std::vector<Configuration> all = presetConfigurations();
    all.push_back(iibConfigurations().front());
    ResultTable table(options.out + "/ratios.csv",
            {"set", "sequence", "target", "kind", "descriptor", "rule", "correct", "given"}, 6);
    std::vector<Task> tasks;
    for (const ImagePair& pair : pairs)
        if (!table.has({pair.set, pair.sequence, pair.target, pair.kind, all.back().name, ruleName(0.95f)}))
            tasks.push_back({pair.name(), [&, pair] { evaluatePair(options, pair, all, table); }});
    const int skipped = runTasks("ratios", tasks);
    table.finish();
    return skipped;
}

}  // namespace iib_tools
