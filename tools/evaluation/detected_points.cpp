// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include <cmath>

#include "detectors.hpp"
#include "experiments.hpp"
#include "common/metrics.hpp"
#include "results.hpp"
#include "tasks.hpp"

namespace iib_tools {
namespace {

const int THRESHOLDS = 64;

struct Described
{
    cv::Mat descriptors;
    int norm, bytes;
};

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

struct DetectedPair
{
    std::vector<cv::KeyPoint> reference, target;
    cv::Matx33d homography;
    int correspondences;
};

void compare(const Fields& key, const std::string& kind, const DetectedPair& pair, const Described& reference,
        const Described& target, double tolerance, ResultTable& table)
{
    const std::vector<cv::DMatch> matches =
            mutualMatches(reference.descriptors, target.descriptors, reference.norm);
    std::vector<bool> correct;
    for (const cv::DMatch& m : matches)
        correct.push_back(
                correspond(pair.reference[m.queryIdx], pair.target[m.trainIdx], pair.homography, tolerance));
    const Counts n = countsOf(correct, pair.correspondences);
    Fields row = key;
    for (const std::string& field : {kind, std::to_string(reference.bytes), std::to_string(n.correct),
                 std::to_string(n.putative), std::to_string(n.correspondences), text(precision(n)),
                 text(recall(n)), curveText(matchCurve(matches, correct, thresholds(reference)))})
        row.push_back(field);
    table.append(row);
}

Described withIIB(const cv::Mat& image, const Detector& detector, std::vector<cv::KeyPoint> keypoints)
{
    Described d = {cv::Mat(), cv::NORM_HAMMING, 0};
    const cv::Ptr<cv::Feature2D> iib = defaultIIB(detector.scaleFactor);
    iib->compute(image, keypoints, d.descriptors);
    d.bytes = descriptorBytes(*iib);
    return d;
}

Described ofDetection(const Detection& detection)
{
    return {detection.descriptors, detection.norm,
            int(detection.descriptors.cols * detection.descriptors.elemSize())};
}

void evaluatePair(const Options& options, const ImagePair& pair, const std::vector<Detector>& detectors,
        ResultTable& table)
{
    const LoadedPair loaded = loadPair(pair);
    for (const Detector& detector : detectors)
    {
        const Detection a = detector.detect(loaded.reference, pair, pair.referenceFile);
        const Detection b = detector.detect(loaded.target, pair, pair.targetFile);
        const DetectedPair detected = {a.keypoints, b.keypoints, loaded.homography,
                countCorrespondences(a.keypoints, b.keypoints, loaded.homography, options.tolerance)};
        const Fields key = {pair.set, pair.sequence, pair.target, detector.name};
        Fields own = key, iib = key;
        own.push_back(detector.descriptor);
        iib.push_back("IIB");
        if (!detector.descriptor.empty())
            compare(own, pair.kind, detected, ofDetection(a), ofDetection(b), options.tolerance, table);
        compare(iib, pair.kind, detected, withIIB(loaded.reference, detector, a.keypoints),
                withIIB(loaded.target, detector, b.keypoints), options.tolerance, table);
    }
}

}  // namespace

int detectedPoints(const Options& options, const std::vector<ImagePair>& pairs)
{
    const std::vector<Detector> all = detectors(options);
    ResultTable table(options.out + "/detected_points.csv",
            {"set", "sequence", "target", "detector", "descriptor", "kind", "bytes", "correct", "putative",
                    "correspondences", "precision", "recall", "curve"},
            5);
    std::vector<Task> tasks;
    for (const ImagePair& pair : pairs)
    {
        std::vector<Detector> missing;
        for (const Detector& d : all)
            if (pair.kind == "light" && !table.has({pair.set, pair.sequence, pair.target, d.name, "IIB"}))
                missing.push_back(d);
        if (!missing.empty())
            tasks.push_back({pair.name(),
                    [&options, &table, pair, missing] { evaluatePair(options, pair, missing, table); }});
    }
    const int skipped = runTasks("detected points", tasks);
    table.finish();
    return skipped;
}

}  // namespace iib_tools
