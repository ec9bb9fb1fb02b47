// SPDX-License-Identifier: Apache-2.0

#include <cstdio>

#include "experiments.hpp"
#include "opencv2/iib.hpp"
#include "results.hpp"
#include "seeded.hpp"
#include "tasks.hpp"

namespace iib_tools {
namespace {

using cv::iib::HierarchicalMatcher;

struct Matcher
{
    std::string name;
    int mode;
    float threshold;
};

//! The paper's figure: brute force and thresholds per level; ADAPTIVE is this module's own.
std::vector<Matcher> matchers()
{
    std::vector<Matcher> all = {
            {"EXACT", HierarchicalMatcher::EXACT, 0}, {"ADAPTIVE", HierarchicalMatcher::ADAPTIVE, 0}};
    for (int percent = 20; percent <= 50; percent += 5)
    {
        char name[16];
        std::snprintf(name, sizeof(name), "H-t-0.%02d", percent);
        all.push_back({name, HierarchicalMatcher::THRESHOLD, float(percent) / 100});
    }
    return all;
}

void evaluatePair(const Options& options, const ImagePair& pair, ResultTable& table)
{
    const Configuration iib = iibConfigurations().front();
    const std::vector<int> levels = iib.create().dynamicCast<cv::iib::IIB>()->levelSizes();
    const LoadedPair loaded = loadPair(pair);
    const SeedPoints seeds =
            SeedSource(loaded.reference, options.points).seeds(iib, loaded.target.size(), loaded.homography);
    const Description query = describe(iib, loaded.reference, {}, seeds.reference);
    const Description train = describe(iib, loaded.target, {}, seeds.target);
    for (const Matcher& m : matchers())
    {
        const cv::Ptr<HierarchicalMatcher> matcher =
                HierarchicalMatcher::create(levels, m.mode, m.threshold, true);
        std::vector<cv::DMatch> matches;
        if (!query.descriptors.empty())
            matcher->match(query.descriptors, train.descriptors, matches);
        const Counts n = countsOf(correctByLocation(matches, query.keypoints, train.keypoints,
                                          loaded.homography, options.tolerance),
                int(seeds.reference.size()));
        Fields row = withCounts({pair.set, pair.sequence, pair.target, m.name}, n);
        row.push_back(text(matcher->matchCost()));
        table.append(row);
    }
}

}  // namespace

int matchingStudy(const Options& options, const std::vector<ImagePair>& pairs)
{
    ResultTable table(options.out + "/matching.csv",
            {"set", "sequence", "target", "matcher", "correct", "putative", "correspondences", "precision",
                    "recall", "cost"},
            4);
    std::vector<Task> tasks;
    for (const ImagePair& pair : pairs)
        if (pair.kind == "light" &&
                !table.has({pair.set, pair.sequence, pair.target, matchers().back().name}))
            tasks.push_back({pair.name(), [&options, &table, pair] { evaluatePair(options, pair, table); }});
    const int skipped = runTasks("hierarchical matching", tasks);
    table.finish();
    return skipped;
}

}  // namespace iib_tools
