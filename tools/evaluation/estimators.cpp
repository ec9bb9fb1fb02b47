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

const double THRESHOLDS[] = {.75, 1};  // of MAGSAC, pixels
const char LAST[] = "findRelativePose";

//! What a detector's points are described with: its own descriptor, or what createRecommended describes with.
std::string descriptorOf(const Detector& detector)
{
    return detector.descriptor.empty() ? "IIB UNIVERSAL" : detector.descriptor;
}

//! Camera matrices, rotation, translation: 9, 9, 9 and 3 numbers; x and y of each match in both images.
std::string numbers(const ViewPair& pair, const Points& points)
{
    std::string out;
    for (const cv::Matx33d& m : {pair.referenceCamera, pair.targetCamera, pair.rotation})
        for (double value : m.val)
            out += cv::format("%.12g ", value);
    for (double value : pair.translation.val)
        out += cv::format("%.12g ", value);
    for (size_t i = 0; i < points.reference.size(); i++)
        for (double value :
                {points.reference[i].x, points.reference[i].y, points.target[i].x, points.target[i].y})
            out += cv::format("%.3f ", value);
    return out;
}

void evaluatePair(const ViewPair& pair, const std::vector<Detector>& detectors, DescribedImages& described,
        ResultTable& errors, ResultTable& matched)
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
            if (r.name != descriptorOf(detector))
                continue;
            const std::vector<cv::DMatch> matches =
                    inBoth(ratioMatches(r, t), mutualMatches(r.descriptors, t.descriptors, r.norm));
            const std::pair<const char*, Points> kinds[] = {{"plain", pointsOf(matches, r, t)},
                    {"refined", refined(reference, target, matches, r, t)}};
            for (const auto& kind : kinds)
            {
                const Fields key = {pair.set, pair.sequence, pair.target, detector.name, r.name, kind.first};
                const auto tell = [&](const std::string& estimator, const Outcome& outcome) {
                    Fields row = key;
                    row.insert(row.end(), {estimator, text(outcome.error), std::to_string(outcome.inliers)});
                    errors.append(row);
                };
                Fields row = key;
                row.push_back(numbers(pair, kind.second));
                matched.append(row);
                for (double threshold : THRESHOLDS)
                    tell(cv::format("MAGSAC %g px", threshold), byMagsac(kind.second, pair, threshold));
                tell(LAST, byFindRelativePose(kind.second, pair));
            }
        }
    }
}

}  // namespace

int estimators(const Options& options, const std::vector<ImagePair>&)
{
    Options few = options;
    if (few.detectors.empty())
        few.detectors = {"ORB", "AKAZE", "SIFT", "SIFT normalized", "Hessian"};
    const std::vector<Detector> all = detectors(few);
    const Fields key = {"set", "sequence", "target", "detector", "descriptor", "points"};
    Fields columns = key;
    columns.insert(columns.end(), {"estimator", "error", "inliers"});
    ResultTable errors(options.out + "/estimators.csv", columns, 7);
    columns = key;
    columns.push_back("numbers");
    ResultTable matched(options.out + "/matched_points.csv", columns, 6);
    DescribedImages described;
    std::vector<Task> tasks;
    for (const ViewPair& pair : findViewPairs(options.roots))
    {
        std::vector<Detector> missing;
        for (const Detector& d : all)
            if (!errors.has({pair.set, pair.sequence, pair.target, d.name, descriptorOf(d), "refined", LAST}))
                missing.push_back(d);
        if (!missing.empty())
            tasks.push_back({pair.set + "/" + pair.sequence + "/" + pair.target,
                    [&, pair, missing] { evaluatePair(pair, missing, described, errors, matched); }});
    }
    const int skipped = runTasks("estimators", tasks);
    errors.finish();
    matched.finish();
    return skipped;
}

}  // namespace iib_tools
