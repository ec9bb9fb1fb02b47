// SPDX-License-Identifier: Apache-2.0

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "common/metrics.hpp"
#include "common/views.hpp"
#include "described_images.hpp"
#include "experiments.hpp"
#include "opencv2/calib3d.hpp"
#include "opencv2/imgcodecs.hpp"
#include "results.hpp"
#include "tasks.hpp"

namespace iib_tools {
namespace {

const double THRESHOLDS[] = {.75, 1, 2};  // of MAGSAC, pixels
const double CONFIDENCE = 0.9999;
const int ITERATIONS = 2000;
const float RATIO_BITS = 0.9f, RATIO_FLOAT = 0.8f;  // a nearest neighbour's distance over the second's
const double FAILED = std::numeric_limits<double>::infinity();

struct Points
{
    std::vector<cv::Point2d> reference, target;
};

//! What an estimate from matches errs, and how many of them agree with it.
struct Outcome
{
    double error;
    int inliers;
};
typedef std::function<Outcome(const Points&, double threshold)> Estimator;

std::vector<cv::DMatch> ratioMatches(const Described& reference, const Described& target)
{
    std::vector<cv::DMatch> kept;
    if (reference.descriptors.empty() || target.descriptors.rows < 2)
        return kept;
    std::vector<std::vector<cv::DMatch>> nearest;
    cv::BFMatcher(reference.norm).knnMatch(reference.descriptors, target.descriptors, nearest, 2);
    const float ratio = reference.norm == cv::NORM_HAMMING ? RATIO_BITS : RATIO_FLOAT;
    for (const std::vector<cv::DMatch>& two : nearest)
        if (two[0].distance < ratio * two[1].distance)
            kept.push_back(two[0]);
    return kept;
}

//! Those that both choices hold.
std::vector<cv::DMatch> inBoth(const std::vector<cv::DMatch>& a, const std::vector<cv::DMatch>& b)
{
    std::set<std::pair<int, int>> pairs;
    for (const cv::DMatch& m : b)
        pairs.insert({m.queryIdx, m.trainIdx});
    std::vector<cv::DMatch> kept;
    for (const cv::DMatch& m : a)
        if (pairs.count({m.queryIdx, m.trainIdx}))
            kept.push_back(m);
    return kept;
}

//! A choice of matches and the estimator's threshold, as the table names them.
std::string ruleName(const std::string& choice, double threshold)
{
    return choice + cv::format(" at %g px", threshold);
}

Points pointsOf(const std::vector<cv::DMatch>& matches, const Described& reference, const Described& target)
{
    Points points;
    for (const cv::DMatch& m : matches)
    {
        points.reference.push_back(reference.keypoints[m.queryIdx].pt);
        points.target.push_back(target.keypoints[m.trainIdx].pt);
    }
    return points;
}

//! Mean distance of the reference's corners from where they belong.
Outcome homographyError(const Points& points, const cv::Matx33d& truth, cv::Size size, double threshold)
{
    if (points.reference.size() < 4)
        return {FAILED, 0};
    cv::Mat mask;
    const cv::Mat found = cv::findHomography(
            points.reference, points.target, cv::USAC_MAGSAC, threshold, mask, ITERATIONS, CONFIDENCE);
    if (found.empty())
        return {FAILED, 0};
    double sum = 0;
    for (const cv::Point2d& corner : {cv::Point2d(0, 0), cv::Point2d(size.width - 1, 0),
                 cv::Point2d(0, size.height - 1), cv::Point2d(size.width - 1, size.height - 1)})
        sum += cv::norm(project(cv::Matx33d(found), corner) - project(truth, corner)) / 4;
    return {sum, cv::countNonZero(mask)};
}

//! Pixel to direction in the camera's axes, third coordinate 1.
std::vector<cv::Point2d> normalizedPoints(const std::vector<cv::Point2d>& points, const cv::Matx33d& camera)
{
    std::vector<cv::Point2d> rays;
    for (const cv::Point2d& p : points)
        rays.push_back({(p.x - camera(0, 2)) / camera(0, 0), (p.y - camera(1, 2)) / camera(1, 1)});
    return rays;
}

double degrees(double cosine) { return std::acos(std::max(-1., std::min(1., cosine))) * 180 / CV_PI; }

//! The larger one of the errors in degrees of rotation and of the direction of the translation, its sign apart.
Outcome poseError(const Points& points, const ViewPair& pair, double threshold)
{
    if (points.reference.size() < 6)
        return {FAILED, 0};
    const std::vector<cv::Point2d> a = normalizedPoints(points.reference, pair.referenceCamera),
                                   b = normalizedPoints(points.target, pair.targetCamera);
    const cv::Matx33d one = cv::Matx33d::eye();
    cv::Mat mask, rotation, translation;
    const cv::Mat essential = cv::findEssentialMat(
            a, b, one, cv::USAC_MAGSAC, CONFIDENCE, threshold / pair.targetCamera(0, 0), mask);
    if (essential.rows != 3)
        return {FAILED, 0};
    const int inliers = cv::countNonZero(mask);
    cv::recoverPose(essential, a, b, one, rotation, translation, mask);
    const cv::Matx33d rest = cv::Matx33d(rotation).t() * pair.rotation;
    const cv::Vec3d found(translation.at<double>(0), translation.at<double>(1), translation.at<double>(2));
    const double direction =
            degrees(std::abs(found.dot(pair.translation)) / cv::norm(found) / cv::norm(pair.translation));
    return {std::max(degrees((cv::trace(rest) - 1) / 2), direction), inliers};
}

//! Mean distance of the known correspondences from their epipolar lines in the target.
Outcome epipolarError(const Points& points, const std::vector<cv::Vec4d>& correspondences, double threshold)
{
    if (points.reference.size() < 8)
        return {FAILED, 0};
    cv::Mat mask;
    const cv::Mat found = cv::findFundamentalMat(
            points.reference, points.target, cv::USAC_MAGSAC, threshold, CONFIDENCE, ITERATIONS, mask);
    if (found.rows != 3)
        return {FAILED, 0};
    const cv::Matx33d fundamental(found);
    double sum = 0;
    for (const cv::Vec4d& c : correspondences)
    {
        const cv::Vec3d line = fundamental * cv::Vec3d(c[0], c[1], 1);
        sum += std::abs(line.dot(cv::Vec3d(c[2], c[3], 1))) / std::hypot(line[0], line[1]);
    }
    return {sum / double(correspondences.size()), cv::countNonZero(mask)};
}

struct Images
{
    ImagePair names;
    cv::Mat reference, target;
};

//! What all tasks of a run share.
struct Run
{
    Run(const std::vector<Detector>& all, const std::string& file)
        : detectors(all), table(file,
                                  {"task", "set", "sequence", "target", "detector", "descriptor", "matching",
                                          "error", "inliers"},
                                  7)
    {
    }

    const std::vector<Detector> detectors;
    DescribedImages described;
    ResultTable table;
};

void evaluateImages(const std::string& task, const Images& images, const std::vector<Detector>& detectors,
        const Estimator& estimate, Run& run)
{
    for (const Detector& detector : detectors)
    {
        const auto both = run.described.both(detector, images.reference, images.target, images.names);
        for (size_t i = 0; i < both.first->size(); i++)
        {
            const Described &r = (*both.first)[i], &t = (*both.second)[i];
            const std::vector<cv::DMatch> ratio = ratioMatches(r, t),
                                          mutual = mutualMatches(r.descriptors, t.descriptors, r.norm);
            const std::pair<const char*, std::vector<cv::DMatch>> choices[] = {
                    {"ratio", ratio}, {"mutual", mutual}, {"both", inBoth(ratio, mutual)}};
            for (const auto& choice : choices)
            {
                const Points points = pointsOf(choice.second, r, t);
                for (double threshold : THRESHOLDS)
                {
                    const Outcome o = estimate(points, threshold);
                    run.table.append({task, images.names.set, images.names.sequence, images.names.target,
                            detector.name, r.name, ruleName(choice.first, threshold), text(o.error),
                            std::to_string(o.inliers)});
                }
            }
        }
    }
}

//! Those of which the table lacks the row that is written last.
std::vector<Detector> missing(const std::string& task, const ImagePair& names, const Run& run)
{
    std::vector<Detector> rest;
    for (const Detector& d : run.detectors)
        if (!run.table.has({task, names.set, names.sequence, names.target, d.name, "IIB",
                    ruleName("both", THRESHOLDS[2])}))
            rest.push_back(d);
    return rest;
}

Images imagesOf(const ViewPair& pair)
{
    Images images;
    images.names.set = pair.set;
    images.names.sequence = pair.sequence;
    images.names.target = pair.target;
    images.names.referenceFile = pair.referenceFile;
    images.names.targetFile = pair.targetFile;
    return images;
}

void addPoses(const Options& options, Run& run, std::vector<Task>& tasks)
{
    for (const ViewPair& pair : findViewPairs(options.roots))
    {
        Images images = imagesOf(pair);
        const std::vector<Detector> rest = missing("pose", images.names, run);
        if (rest.empty())
            continue;
        tasks.push_back({images.names.name(), [&run, pair, images, rest]() mutable {
                             images.reference = readImage(pair.referenceFile, cv::IMREAD_GRAYSCALE);
                             images.target = readImage(pair.targetFile, cv::IMREAD_GRAYSCALE);
                             const auto estimate = [&](const Points& p, double threshold) {
                                 return poseError(p, pair, threshold);
                             };
                             evaluateImages("pose", images, rest, estimate, run);
                         }});
    }
}

void addImagePairs(const std::vector<ImagePair>& pairs, Run& run, std::vector<Task>& tasks)
{
    for (const ImagePair& pair : pairs)
    {
        const std::string task = pair.correspondencesFile.empty() ? "homography" : "epipolar";
        const std::vector<Detector> rest = missing(task, pair, run);
        if (rest.empty())
            continue;
        tasks.push_back(
                {pair.name(), [&run, pair, rest, task] {
                     const LoadedPair loaded = loadPair(pair);
                     const auto estimate = [&](const Points& p, double threshold) {
                         return task == "epipolar" ? epipolarError(p, loaded.correspondences, threshold)
                                                   : homographyError(p, loaded.homography,
                                                             loaded.reference.size(), threshold);
                     };
                     evaluateImages(task, {pair, loaded.reference, loaded.target}, rest, estimate, run);
                 }});
    }
}

}  // namespace

int wholeTasks(const Options& options, const std::vector<ImagePair>& pairs)
{
    Options classic = options;
    classic.keypoints.clear();
    classic.network.clear();
    if (classic.detectors.empty())
        classic.detectors = {"ORB", "AKAZE", "SIFT", "ORB normalized", "AKAZE normalized", "SIFT normalized",
                "Hessian", "Hessian x2"};
    Run run(detectors(classic), options.out + "/whole_tasks.csv");
    std::vector<Task> tasks;
    addPoses(options, run, tasks);
    addImagePairs(pairs, run, tasks);
    const int skipped = runTasks("whole tasks", tasks);
    run.table.finish();
    return skipped;
}

}  // namespace iib_tools
