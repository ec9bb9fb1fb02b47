// SPDX-License-Identifier: Apache-2.0

#include <cmath>
#include <map>

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

//! Appends rows of the reference's descriptors with those of a target.
void comparePair(const Options& options, const ImagePair& pair, const LoadedPair& loaded,
        const Detector& detector, const std::vector<Described>& reference, ResultTable& table)
{
    const std::vector<Described> target = describeAll(detector, loaded.target, pair.targetFile);
    // The last descriptor, IIB, keeps every point.
    const int correspondences = countCorrespondences(
            reference.back().keypoints, target.back().keypoints, loaded.homography, options.tolerance);
    for (size_t i = 0; i < reference.size(); i++)
    {
        const Described &r = reference[i], &t = target[i];
        const std::vector<cv::DMatch> matches = mutualMatches(r.descriptors, t.descriptors, r.norm);
        std::vector<bool> correct;
        for (const cv::DMatch& m : matches)
            correct.push_back(correspond(
                    r.keypoints[m.queryIdx], t.keypoints[m.trainIdx], loaded.homography, options.tolerance));
        const Counts n = countsOf(correct, correspondences);
        table.append(with(withCounts(with(pair.key(), detector.name, r.name, pair.kind, r.bytes), n),
                curve(matches, correct, unrelated(r))));
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
    std::map<std::string, std::vector<ImagePair>> sequences;  // by the reference, which is described once
    for (const ImagePair& pair : pairs)
        if (pair.kind == "light")
            sequences[pair.referenceFile].push_back(pair);
    const auto isMissing = [&](const ImagePair& pair, const Detector& d) {
        return d.knows(pair.referenceFile) && d.knows(pair.targetFile) &&
               !experiment.table.has(with(pair.key(), d.name, "IIB"));  // written last
    };
    for (const auto& sequence : sequences)
        for (const Detector& detector : all)
        {
            std::vector<ImagePair> missing;
            for (const ImagePair& pair : sequence.second)
                if (isMissing(pair, detector))
                    missing.push_back(pair);
            const auto run = [&, missing, detector] {
                const std::vector<Described> reference =
                        describeAll(detector, loadPair(missing[0]).reference, missing[0].referenceFile);
                for (const ImagePair& pair : missing)
                    comparePair(options, pair, loadPair(pair), detector, reference, experiment.table);
            };
            if (!missing.empty())
                experiment.plan({}, missing[0].name() + " and others, " + detector.name, run);
        }
    return experiment.run();
}

}  // namespace iib_tools
