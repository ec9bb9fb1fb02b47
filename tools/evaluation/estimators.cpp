// SPDX-License-Identifier: Apache-2.0

#include "common/dataset.hpp"
#include "common/views.hpp"
#include "detectors.hpp"
#include "experiments.hpp"
#include "opencv2/imgcodecs.hpp"
#include "pose_estimates.hpp"
#include "results.hpp"

namespace iib_tools {
namespace {

const double THRESHOLDS[] = {.75, 1};  // of MAGSAC, pixels
const char LAST[] = "findRelativePose", UNIVERSAL[] = "IIB UNIVERSAL";
const int LIGHTS = 3;

//! Two views, and the artificial illumination of the second image, 0 to 2; -1: none.
struct LitPair
{
    ViewPair views;
    int light;
};

/** Changes the illumination of a grey image and adds a sensor's noise.
@param light 0: darker from left to right with deep shadows; 1: bright; 2: dark from above. */
cv::Mat relit(const cv::Mat& image, int light)
{
    const struct
    {
        double gamma, left, right, top, bottom, noise;
    } all[LIGHTS] = {{2.2, 1, .25, 1, 1, 2}, {.45, 1, 1, 1, 1, 3}, {1.5, .3, .3, .4, 1.2, 4}}, l = all[light];
    cv::Mat_<float> out, noise(image.size());
    image.convertTo(out, CV_32F, 1 / 255.);
    cv::pow(out, l.gamma, out);
    cv::RNG(light + 1).fill(noise, cv::RNG::NORMAL, 0, l.noise);
    for (int y = 0; y < out.rows; y++)
        for (int x = 0; x < out.cols; x++)
            out(y, x) = float(out(y, x) * 255 * (l.left + (l.right - l.left) * x / out.cols) *
                                      (l.top + (l.bottom - l.top) * y / out.rows) +
                              noise(y, x));
    cv::Mat bytes;
    out.convertTo(bytes, CV_8U);
    return bytes;
}

//! Adds a pair with changed illumination, in the set "... relit", for each pair under one illumination.
std::vector<LitPair> withRelit(const std::vector<ViewPair>& pairs)
{
    std::vector<LitPair> all;
    int light = 0;
    for (const ViewPair& pair : pairs)
    {
        all.push_back({pair, -1});
        if (!pair.sameLight)
            continue;
        all.push_back({pair, light++ % LIGHTS});
        all.back().views.set += " relit";
    }
    return all;
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

//! The detectors, each with its own descriptor and with UNIVERSAL.
std::vector<Detector> describedByTwo(Options options)
{
    if (options.detectors.empty())
        options.detectors = {"SIFT", "SIFT normalized", "Hessian"};
    std::vector<Detector> all = detectors(options);
    for (Detector& detector : all)
        detector.only = {detector.descriptor, UNIVERSAL};
    return all;
}

}  // namespace

int estimators(const Options& options, const std::vector<ImagePair>&)
{
    const Fields key = {"set", "sequence", "target", "detector", "descriptor", "points"};
    Experiment experiment(options.out, "estimators", with(key, "estimator", "error", "inliers"), 7);
    ResultTable matched(options.out + "/matched_points.csv", with(key, "numbers"), 6);

    const auto judge = [&](const ViewPair& pair, const std::string& detector, const cv::Mat& reference,
                               const cv::Mat& target, const Described& r, const Described& t) {
        const std::vector<cv::DMatch> matches = mutualRatioMatches(r, t);
        const std::pair<const char*, Points> kinds[] = {{"plain", pointsOf(matches, r, t)},
                {"refined", refined(reference, target, matches, r, t, false)},
                {"propagated", refined(reference, target, matches, r, t, true)}};
        for (const auto& kind : kinds)
        {
            const Fields pairKey = with(pair.key(), detector, r.name, kind.first);
            const auto append = [&](const std::string& estimator, const Outcome& outcome) {
                experiment.table.append(with(pairKey, estimator, outcome.error, outcome.inliers));
            };
            matched.append(with(pairKey, numbers(pair, kind.second)));
            for (double threshold : THRESHOLDS)
                append(cv::format("MAGSAC %g px", threshold), byMagsac(kind.second, pair, threshold));
            append(LAST, byFindRelativePose(kind.second, pair));
        }
    };

    DescribedImages described;
    const std::vector<Detector> all = describedByTwo(options);
    const std::vector<LitPair> pairs = withRelit(findViewPairs(options.roots));
    for (const LitPair& pair : pairs)
    {
        std::vector<Detector> missing;
        for (const Detector& d : all)
            if (!experiment.table.has(with(pair.views.key(), d.name, UNIVERSAL, "propagated", LAST)))
                missing.push_back(d);
        const auto run = [&, missing] {
            const ViewPair& views = pair.views;
            const cv::Mat reference = readImage(views.referenceFile);
            cv::Mat target = readImage(views.targetFile);
            std::string name = views.targetFile;
            if (pair.light >= 0)
            {
                target = relit(target, pair.light);
                name += cv::format(" relit %d", pair.light);
            }
            for (const Detector& detector : missing)
            {
                const DescribedImages::Result r = described.get(detector, reference, views.referenceFile),
                                              t = described.get(detector, target, name);
                for (size_t i = 0; i < r->size(); i++)
                    judge(views, detector.name, reference, target, (*r)[i], (*t)[i]);
            }
        };
        if (!missing.empty())
            experiment.plan({}, pair.views.name(), run);
    }
    const int skipped = experiment.run();
    matched.finish();
    return skipped;
}

}  // namespace iib_tools
