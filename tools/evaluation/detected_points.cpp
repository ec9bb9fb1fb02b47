// SPDX-License-Identifier: Apache-2.0

#include "described_images.hpp"
#include "experiments.hpp"
#include "results.hpp"
#include "tasks.hpp"

namespace iib_tools {
namespace {

void evaluatePair(const Options& options, const ImagePair& pair, const std::vector<Detector>& detectors,
        DescribedImages& described, ResultTable& table)
{
    const LoadedPair loaded = loadPair(pair);
    for (const Detector& detector : detectors)
    {
        const DescribedImages::Result ofReference =
                                              described.get(detector, loaded.reference, pair.referenceFile),
                                      ofTarget = described.get(detector, loaded.target, pair.targetFile);
        const std::vector<Described>&reference = *ofReference, &target = *ofTarget;
        // IIB, the last one, keeps every point.
        const int correspondences = countCorrespondences(
                reference.back().keypoints, target.back().keypoints, loaded.homography, options.tolerance);
        for (size_t i = 0; i < reference.size(); i++)
        {
            const Described &r = reference[i], &t = target[i];
            const std::vector<cv::DMatch> matches = mutualMatches(r.descriptors, t.descriptors, r.norm);
            std::vector<bool> correct;
            for (const cv::DMatch& m : matches)
                correct.push_back(correspond(r.keypoints[m.queryIdx], t.keypoints[m.trainIdx],
                        loaded.homography, options.tolerance));
            const Counts n = countsOf(correct, correspondences);
            table.append(withCounts({pair.set, pair.sequence, pair.target, detector.name, r.name, pair.kind,
                                            std::to_string(r.bytes)},
                    n));
        }
    }
}

//! Whether the table holds the pair with everything that describes the detector's points, but for its own descriptor,
//! which not all have.
bool isComplete(const ResultTable& table, const ImagePair& pair, const Detector& detector)
{
    for (const std::string& name : describedNames(detector))
        if (!table.has({pair.set, pair.sequence, pair.target, detector.name, name}))
            return false;
    return true;
}

}  // namespace

int detectedPoints(const Options& options, const std::vector<ImagePair>& pairs)
{
    const std::vector<Detector> all = detectors(options);
    ResultTable table(options.out + "/detected_points.csv",
            {"set", "sequence", "target", "detector", "descriptor", "kind", "bytes", "correct", "putative",
                    "correspondences", "precision", "recall"},
            5);
    DescribedImages described;
    std::vector<Task> tasks;
    for (const ImagePair& pair : pairs)
    {
        std::vector<Detector> missing;
        for (const Detector& d : all)
            if (pair.kind == "light" && !isComplete(table, pair, d))
                missing.push_back(d);
        if (!missing.empty())
            tasks.push_back({pair.name(),
                    [&, pair, missing] { evaluatePair(options, pair, missing, described, table); }});
    }
    const int skipped = runTasks("detected points", tasks);
    table.finish();
    return skipped;
}

}  // namespace iib_tools
