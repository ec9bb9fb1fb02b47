// SPDX-License-Identifier: Apache-2.0

#include <algorithm>
#include <cmath>

#include "common/dataset.hpp"
#include "common/views.hpp"
#include "detectors.hpp"
#include "experiments.hpp"
#include "opencv2/imgcodecs.hpp"
#include "opencv2/imgproc.hpp"
#include "pose_estimates.hpp"
#include "results.hpp"

namespace iib_tools {
namespace {

const float RATIOS[] = {.8f, .85f, .9f, .92f, .95f};
const int POINTS[] = {500, 1000, 2000};  // an image, where neighbours are counted
const double NOISE[] = {6, 14};          // grey levels, of the second image
const double CLIP = 2;                   // of CLAHE, OpenCV's tutorials' choice
const double DEPTH_TOLERANCE = .02;      // share of the depth
const double SIFT_SIGMA = 1.6;           // of SIFT's first level, pixels
const int SIFT_LAYERS = 3, BLOCK = 16;

/** SIFT's descriptor at another detector's points. SIFT reads a level of its pyramid from a keypoint; here the size decides it. */
class SiftAt : public cv::Feature2D
{
public:
    void compute(cv::InputArray image, std::vector<cv::KeyPoint>& keypoints, cv::OutputArray out) CV_OVERRIDE
    {
        std::vector<cv::KeyPoint> leveled = keypoints;
        for (cv::KeyPoint& k : leveled)
        {
            const double above = std::log2(k.size / 2 / SIFT_SIGMA);
            const int octave = std::max(-1, int(std::floor(above - 1. / SIFT_LAYERS + 1e-6))),
                      layer = std::max(0, std::min(SIFT_LAYERS, cvRound(SIFT_LAYERS * (above - octave))));
            k.octave = (octave & 255) | (layer << 8);
        }
        cv::SIFT::create()->compute(image, leveled, out);
        CV_Assert(leveled.size() == keypoints.size());
    }
    int descriptorSize() const CV_OVERRIDE { return 128; }
    int descriptorType() const CV_OVERRIDE { return CV_32F; }
    int defaultNorm() const CV_OVERRIDE { return cv::NORM_L2; }
};

//! RootSIFT (Arandjelovic and Zisserman, CVPR 2012): square roots of the descriptor divided by its sum.
Described rooted(Described sift)
{
    sift.name = "RootSIFT";
    sift.descriptors = sift.descriptors.clone();
    for (int i = 0; i < sift.descriptors.rows; i++)
    {
        cv::Mat row = sift.descriptors.row(i);
        row /= std::max(1e-9, cv::norm(row, cv::NORM_L1));
        cv::sqrt(row, row);
    }
    return sift;
}

enum Which
{
    ALL,
    COUNTED,  // those whose neighbours are also counted for other numbers of points
    NOISY     // those whose poses are also estimated with noise
};

//! Each detector with the descriptors that are compared at its points.
std::vector<Detector> methods(Options options, int points, Which which)
{
    options.points = points;
    options.detectors = {"Hessian", "SIFT normalized", "SIFT", "AKAZE", "ORB"};
    options.keypoints.clear();
    std::vector<Detector> all = detectors(options);
    for (Detector& d : all)
    {
        d.others.clear();
        d.only = {d.descriptor};
    }
    Detector &hessian = all[0], clahe = all[2];
    hessian.only = {"IIB UNIVERSAL"};
    hessian.others = {
            {"SIFT", []() -> cv::Ptr<cv::Feature2D> { return cv::makePtr<SiftAt>(); }, 0, "", {}, false}};
    hessian.only.push_back("SIFT");
    if (which == NOISY)
        return {all[0], all[1], all[2]};
    if (which == COUNTED)
        return {all[0], all[1]};
    hessian.only.push_back("IIB SMALL");
    all[1].only.push_back("IIB UNIVERSAL");
    const auto sift = clahe.detect;
    clahe.name = "SIFT CLAHE";
    clahe.detect = [sift](const cv::Mat& image, const std::string& file) {
        cv::Mat equalized;
        cv::createCLAHE(CLIP)->apply(image, equalized);
        return sift(equalized, file);
    };
    all.push_back(clahe);
    return all;
}

//! Metres along the optical axis, where views.py wrote the depth of an image; empty otherwise.
cv::Mat depthOf(const std::string& file)
{
    cv::Mat metres;
    cv::imread(depthFile(file), cv::IMREAD_UNCHANGED).convertTo(metres, CV_32F, DEPTH_STEP);
    return metres;
}

//! Mean over blocks of the standard deviation of grey levels.
double contrastOf(const cv::Mat& image)
{
    double sum = 0;
    int count = 0;
    for (int y = 0; y + BLOCK <= image.rows; y += BLOCK)
        for (int x = 0; x + BLOCK <= image.cols; x += BLOCK, count++)
        {
            cv::Scalar mean, deviation;
            cv::meanStdDev(image(cv::Rect(x, y, BLOCK, BLOCK)), mean, deviation);
            sum += deviation[0];
        }
    return sum / std::max(1, count);
}

struct Neighbours
{
    int visible, repeated, nearest;
};

/** Counts points of an image by the known depths: those that the other image shows, those that were also detected there, and those
whose nearest descriptor is at that place. */
Neighbours neighboursOf(const ViewPair& pair, const Described& r, const Described& t, const cv::Mat& depth,
        const cv::Mat& targetDepth, double tolerance)
{
    Neighbours count = {0, 0, 0};
    std::vector<cv::DMatch> nearest;
    if (!r.descriptors.empty() && !t.descriptors.empty())
        cv::BFMatcher(r.norm).match(r.descriptors, t.descriptors, nearest);
    for (const cv::DMatch& match : nearest)
    {
        const cv::Point2f p = r.keypoints[match.queryIdx].pt;
        const double d = depth.at<float>(cvRound(p.y), cvRound(p.x));
        const cv::Vec3d x = pair.targetCamera *
                            (pair.rotation * (pair.referenceCamera.inv() * cv::Vec3d(p.x, p.y, 1) * d) +
                                    pair.translation);
        const cv::Point2d q(x[0] / x[2], x[1] / x[2]);
        if (d <= 0 || x[2] <= 0 || !cv::Rect(0, 0, depth.cols - 1, depth.rows - 1).contains(q))
            continue;
        if (std::abs(targetDepth.at<float>(cvRound(q.y), cvRound(q.x)) - x[2]) >
                DEPTH_TOLERANCE * x[2] + DEPTH_STEP)
            continue;
        const auto near = [&](const cv::KeyPoint& k) { return cv::norm(cv::Point2d(k.pt) - q) <= tolerance; };
        count.visible++;
        count.repeated += std::any_of(t.keypoints.begin(), t.keypoints.end(), near);
        count.nearest += near(t.keypoints[match.trainIdx]);
    }
    return count;
}

cv::Mat withNoise(const cv::Mat& image, double sigma)
{
    cv::Mat noise(image.size(), CV_32F), out;
    cv::RNG(1).fill(noise, cv::RNG::NORMAL, 0, sigma);
    cv::add(image, noise, out, cv::noArray(), CV_8U);
    return out;
}

}  // namespace

int controls(const Options& options, const std::vector<ImagePair>&)
{
    const Fields names = {"set", "sequence", "target", "detector", "descriptor"};
    Experiment experiment(options.out, "controls", with(names, "noise", "ratio", "error", "matches"), 7);
    ResultTable neighbours(options.out + "/neighbours.csv",
            with(names, "points", "baseline", "contrast", "visible", "repeated", "nearest"), 6);
    DescribedImages described;
    const std::string last[] = {"SIFT CLAHE", "SIFT"};
    for (const ViewPair& pair : findViewPairs(options.roots))
    {
        const auto run = [&, pair] {
            const cv::Mat reference = readImage(pair.referenceFile), target = readImage(pair.targetFile),
                          depth = depthOf(pair.referenceFile), targetDepth = depthOf(pair.targetFile);
            const auto eachMethod = [&](const cv::Mat& other, double noise, int points, Which which,
                                            const std::function<void(const Fields&, const Described&,
                                                    const Described&)>& use) {
                const std::string tag = cv::format(" %d points %d noise %g", points, which, noise);
                for (const Detector& detector : methods(options, points, which))
                {
                    const DescribedImages::Result r = described.get(
                                                          detector, reference, pair.referenceFile + tag),
                                                  t = described.get(detector, other, pair.targetFile + tag);
                    for (size_t i = 0; i < r->size(); i++)
                    {
                        const Described &from = (*r)[i], &to = (*t)[i];
                        const Fields key = with(pair.key(), detector.name);
                        use(with(key, from.name), from, to);
                        if (which != COUNTED && from.name == "SIFT" && detector.name != last[0])
                            use(with(key, "RootSIFT"), rooted(from), rooted(to));
                    }
                }
            };
            const auto findPoses = [&](const cv::Mat& other, double noise, const Fields& key,
                                           const Described& from, const Described& to) {
                std::vector<float> ratios;
                const std::vector<cv::DMatch> matches = mutualMatches(from, to, ratios);
                for (float ratio : RATIOS)
                {
                    const Points points =
                            refined(reference, other, underRatio(matches, ratios, ratio), from, to, true);
                    experiment.table.append(with(key, noise, ratio, byFindRelativePose(points, pair).error,
                            points.reference.size()));
                }
            };
            const auto countNeighbours = [&](int points, const Fields& key, const Described& from,
                                                 const Described& to) {
                const Neighbours n = neighboursOf(pair, from, to, depth, targetDepth, options.tolerance);
                neighbours.append(with(key, points, cv::norm(pair.translation), contrastOf(target), n.visible,
                        n.repeated, n.nearest));
            };
            const bool known = !depth.empty() && !targetDepth.empty();
            for (int points : POINTS)
                if (known && points != options.points)
                    eachMethod(target, 0, points, COUNTED,
                            [&](const Fields& key, const Described& from, const Described& to) {
                                countNeighbours(points, key, from, to);
                            });
            for (double noise : NOISE)
            {
                const cv::Mat noisy = withNoise(target, noise);
                eachMethod(noisy, noise, options.points, NOISY,
                        [&](const Fields& key, const Described& from, const Described& to) {
                            findPoses(noisy, noise, key, from, to);
                        });
            }
            eachMethod(target, 0, options.points, ALL,
                    [&](const Fields& key, const Described& from, const Described& to) {
                        if (known)
                            countNeighbours(options.points, key, from, to);
                        findPoses(target, 0, key, from, to);
                    });
        };
        experiment.plan(with(pair.key(), last[0], last[1], 0, .95f), pair.name(), run);
    }
    const int skipped = experiment.run();
    neighbours.finish();
    return skipped;
}

}  // namespace iib_tools
