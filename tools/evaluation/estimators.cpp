// SPDX-License-Identifier: Apache-2.0

#include "common/metrics.hpp"
#include "experiments.hpp"
#include "pose_estimates.hpp"
#include "results.hpp"
#include "view_pairs.hpp"

namespace iib_tools {
namespace {

const double THRESHOLDS[] = {.75, 1};  // of MAGSAC, pixels
const char LAST[] = "findRelativePose";

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

}  // namespace

int estimators(const Options& options, const std::vector<ImagePair>&)
{
    Options few = options;
    if (few.detectors.empty())
        few.detectors = {"ORB", "AKAZE", "SIFT", "SIFT normalized", "Hessian"};
    std::vector<Detector> all = detectors(few);
    for (Detector& detector : all)
        detector.only = detector.descriptor.empty() ? "IIB UNIVERSAL" : detector.descriptor;
    const Fields key = {"set", "sequence", "target", "detector", "descriptor", "points"};
    Fields columns = key;
    columns.insert(columns.end(), {"estimator", "error", "inliers"});
    ResultTable errors(options.out + "/estimators.csv", columns, 7);
    columns = key;
    columns.push_back("numbers");
    ResultTable matched(options.out + "/matched_points.csv", columns, 6);
    const auto isDone = [&](const ViewPair& pair, const Detector& d) {
        return errors.has({pair.set, pair.sequence, pair.target, d.name, d.only, "refined", LAST});
    };
    const auto judge = [&](const ViewPair& pair, const Detector& detector, const cv::Mat& reference,
                               const cv::Mat& target, const Described& r, const Described& t) {
        const std::vector<cv::DMatch> matches =
                inBoth(ratioMatches(r, t), mutualMatches(r.descriptors, t.descriptors, r.norm));
        const std::pair<const char*, Points> kinds[] = {
                {"plain", pointsOf(matches, r, t)}, {"refined", refined(reference, target, matches, r, t)}};
        for (const auto& kind : kinds)
        {
            const Fields pairKey = {pair.set, pair.sequence, pair.target, detector.name, r.name, kind.first};
            const auto tell = [&](const std::string& estimator, const Outcome& outcome) {
                Fields row = pairKey;
                row.insert(row.end(), {estimator, text(outcome.error), std::to_string(outcome.inliers)});
                errors.append(row);
            };
            Fields row = pairKey;
            row.push_back(numbers(pair, kind.second));
            matched.append(row);
            for (double threshold : THRESHOLDS)
                tell(cv::format("MAGSAC %g px", threshold), byMagsac(kind.second, pair, threshold));
            tell(LAST, byFindRelativePose(kind.second, pair));
        }
    };
    const int skipped =
            runOnViews("estimators", withRelit(findViewPairs(options.roots)), all, {isDone, judge});
    errors.finish();
    matched.finish();
    return skipped;
}

}  // namespace iib_tools
