// SPDX-License-Identifier: Apache-2.0

#include "common/metrics.hpp"
#include "experiments.hpp"
#include "pose_estimates.hpp"
#include "results.hpp"
#include "view_pairs.hpp"

namespace iib_tools {
namespace {

const double THRESHOLDS[] = {.75, 1, 2};  // of MAGSAC, pixels
//! A choice of matches and MAGSAC's threshold, as the table names them.
std::string ruleName(const std::string& choice, double threshold)
{
    return choice + cv::format(" at %g px", threshold);
}

//! The recommended chain is judged by its own rule of matching alone, its competitors by the best of three.
bool isOwnRule(const std::string& choice, const Detector& detector)
{
    return choice == "both" || detector.name.compare(0, 7, "Hessian") != 0;
}

}  // namespace

int wholeTasks(const Options& options, const std::vector<ImagePair>&)
{
    Options classic = options;
    if (classic.detectors.empty())
        classic.detectors = {"ORB", "AKAZE", "SIFT", "ORB normalized", "AKAZE normalized", "SIFT normalized",
                "Hessian", "Hessian x2"};
    const std::vector<Detector> all = detectors(classic);
    ResultTable table(options.out + "/whole_tasks.csv",
            {"task", "set", "sequence", "target", "detector", "descriptor", "matching", "error", "inliers"},
            7);
    const auto isDone = [&](const ViewPair& pair, const Detector& d) {  // the row that is written last
        return table.has({"pose", pair.set, pair.sequence, pair.target, d.name, "IIB",
                ruleName("both", THRESHOLDS[2])});
    };
    const auto judge = [&](const ViewPair& pair, const Detector& detector, const cv::Mat&, const cv::Mat&,
                               const Described& r, const Described& t) {
        const std::vector<cv::DMatch> ratio = ratioMatches(r, t),
                                      mutual = mutualMatches(r.descriptors, t.descriptors, r.norm);
        const std::pair<const char*, std::vector<cv::DMatch>> choices[] = {
                {"ratio", ratio}, {"mutual", mutual}, {"both", inBoth(ratio, mutual)}};
        for (const auto& choice : choices)
        {
            if (!isOwnRule(choice.first, detector))
                continue;
            const Points points = pointsOf(choice.second, r, t);
            for (double threshold : THRESHOLDS)
            {
                const Outcome o = byMagsac(points, pair, threshold);
                table.append({"pose", pair.set, pair.sequence, pair.target, detector.name, r.name,
                        ruleName(choice.first, threshold), text(o.error), std::to_string(o.inliers)});
            }
        }
    };
    std::vector<LitPair> pairs;
    for (const ViewPair& pair : findViewPairs(options.roots))
        pairs.push_back({pair, -1});
    const int skipped = runOnViews("whole tasks", pairs, all, {isDone, judge});
    table.finish();
    return skipped;
}

}  // namespace iib_tools
