// SPDX-License-Identifier: Apache-2.0

#include <algorithm>

#include "common/metrics.hpp"
#include "common/views.hpp"
#include "described_images.hpp"
#include "experiments.hpp"
#include "opencv2/imgcodecs.hpp"
#include "pose_estimates.hpp"
#include "results.hpp"
#include "tasks.hpp"

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

void evaluatePair(const ViewPair& pair, const std::vector<Detector>& detectors, DescribedImages& described,
        ResultTable& table)
{
    const cv::Mat reference = readImage(pair.referenceFile, cv::IMREAD_GRAYSCALE),
                  target = readImage(pair.targetFile, cv::IMREAD_GRAYSCALE);
    for (const Detector& detector : detectors)
    {
        const DescribedImages::Result ofReference = described.get(detector, reference, pair.referenceFile),
                                      ofTarget = described.get(detector, target, pair.targetFile);
        for (size_t i = 0; i < ofReference->size(); i++)
        {
            const Described &r = (*ofReference)[i], &t = (*ofTarget)[i];
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
        }
    }
}

}  // namespace

int wholeTasks(const Options& options, const std::vector<ImagePair>&)
{
    Options classic = options;
    if (classic.detectors.empty())
        classic.detectors = {"ORB", "AKAZE", "SIFT", "ORB normalized", "AKAZE normalized", "SIFT normalized",
                "Hessian", "Hessian x2"};
    const std::vector<Detector> all = detectors(classic);
    DescribedImages described;
    ResultTable table(options.out + "/whole_tasks.csv",
            {"task", "set", "sequence", "target", "detector", "descriptor", "matching", "error", "inliers"},
            7);
    std::vector<Task> tasks;
    for (const ViewPair& pair : findViewPairs(options.roots))
    {
        std::vector<Detector> missing;  // those of which the table lacks the row that is written last
        for (const Detector& d : all)
            if (!table.has({"pose", pair.set, pair.sequence, pair.target, d.name, "IIB",
                        ruleName("both", THRESHOLDS[2])}))
                missing.push_back(d);
        if (!missing.empty())
            tasks.push_back({pair.set + "/" + pair.sequence + "/" + pair.target,
                    [&, pair, missing] { evaluatePair(pair, missing, described, table); }});
    }
    const int skipped = runTasks("whole tasks", tasks);
    table.finish();
    return skipped;
}

}  // namespace iib_tools
