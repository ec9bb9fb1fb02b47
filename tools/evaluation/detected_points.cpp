// SPDX-License-Identifier: Apache-2.0

#include <cmath>

#include "described_images.hpp"
#include "experiments.hpp"
#include "common/metrics.hpp"
#include "results.hpp"
#include "tasks.hpp"

namespace iib_tools {
namespace {

const int THRESHOLDS = 64;

//! Thresholds in equal steps up to the largest distance: all bits, or opposite corners of a unit sphere's octant.
std::vector<float> thresholds(const Described& reference)
{
    double largest = 8. * reference.bytes;
    if (reference.norm != cv::NORM_HAMMING)
    {
        largest = 0;
        for (int i = 0; i < reference.descriptors.rows; i++)
            largest += std::sqrt(2.) * cv::norm(reference.descriptors.row(i)) / reference.descriptors.rows;
    }
    std::vector<float> steps;
    for (int i = 1; i <= THRESHOLDS; i++)
        steps.push_back(float(largest * i / THRESHOLDS));
    return steps;
}

//! "correct:putative" of each threshold, separated by blanks.
std::string curveText(const std::vector<CurvePoint>& curve)
{
    std::string out;
    for (const CurvePoint& p : curve)
        out += (out.empty() ? "" : " ") + std::to_string(p.correct) + ":" + std::to_string(p.putative);
    return out;
}

//! Whether the page shows how its recall grows with the distance.
bool hasCurve(const Detector& detector, const std::string& descriptor)
{
    return descriptor == "IIB" || descriptor == detector.descriptor || descriptor == "BEBLID-512";
}

void evaluatePair(const Options& options, const ImagePair& pair, const std::vector<Detector>& detectors,
        DescribedImages& described, ResultTable& table)
{
    const LoadedPair loaded = loadPair(pair);
    for (const Detector& detector : detectors)
    {
        const auto both = described.both(detector, loaded.reference, loaded.target, pair);
        const std::vector<Described>&reference = *both.first, &target = *both.second;
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
            table.append({pair.set, pair.sequence, pair.target, detector.name, r.name, pair.kind,
                    std::to_string(r.bytes), std::to_string(n.correct), std::to_string(n.putative),
                    std::to_string(n.correspondences), text(precision(n)), text(recall(n)),
                    hasCurve(detector, r.name) ? curveText(matchCurve(matches, correct, thresholds(r)))
                                               : ""});
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
                    "correspondences", "precision", "recall", "curve"},
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
