// SPDX-License-Identifier: Apache-2.0

#include <cmath>

#include "detectors.hpp"
#include "experiments.hpp"
#include "results.hpp"

namespace iib_tools {
namespace {

const int THRESHOLDS = 32;

//! The distance of unrelated descriptors: half of the bits, or that of vectors at a right angle.
double unrelated(const Described& d)
{
    if (d.norm == cv::NORM_HAMMING)
        return 4. * d.bytes;
    double sum = 0;
    for (int i = 0; i < d.descriptors.rows; i++)
        sum += std::sqrt(2.) * cv::norm(d.descriptors.row(i)) / d.descriptors.rows;
    return sum;
}

/** Numbers of right and all matches with a distance up to 1/32, 2/32 ... of that of unrelated descriptors, as "right:all",
separated by blanks (paper, "Experiments Combined with Feature Detectors"). */
std::string curve(const std::vector<cv::DMatch>& matches, const std::vector<bool>& correct, double largest)
{
    std::string out;
    for (int step = 1; step <= THRESHOLDS; step++)
    {
        int right = 0, all = 0;
        for (size_t i = 0; i < matches.size(); i++)
            if (matches[i].distance <= largest * step / THRESHOLDS)
            {
                right += correct[i];
                all++;
            }
        out += cv::format("%s%d:%d", out.empty() ? "" : " ", right, all);
    }
    return out;
}

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
        // The last descriptor, IIB, keeps every point.
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
            table.append(with(withCounts(with(pair.key(), detector.name, r.name, pair.kind, r.bytes), n),
                    curve(matches, correct, unrelated(r))));
        }
    }
}

}  // namespace

int detectedPoints(const Options& options, const std::vector<ImagePair>& pairs)
{
    const std::vector<Detector> all = detectors(options);
    Experiment experiment(options.out, "detected_points",
            {"set", "sequence", "target", "detector", "descriptor", "kind", "bytes", "correct", "putative",
                    "correspondences", "precision", "recall", "curve"},
            5);
    DescribedImages described;
    for (const ImagePair& pair : pairs)
    {
        std::vector<Detector> missing;
        for (const Detector& d : all)
            if (pair.kind == "light" && d.knows(pair.referenceFile) && d.knows(pair.targetFile) &&
                    !experiment.table.has(with(pair.key(), d.name, "IIB")))  // written last
                missing.push_back(d);
        if (!missing.empty())
            experiment.plan({}, pair.name(), [&, pair, missing] {
                evaluatePair(options, pair, missing, described, experiment.table);
            });
    }
    return experiment.run();
}

}  // namespace iib_tools
