// SPDX-License-Identifier: Apache-2.0

#include <algorithm>
#include <cstdio>
#include <iterator>

#include "common/metrics.hpp"
#include "detectors.hpp"
#include "experiments.hpp"
#include "opencv2/core/utils/filesystem.hpp"
#include "opencv2/imgcodecs.hpp"
#include "results.hpp"

namespace iib_tools {
namespace {

//! Detectors and descriptors of the paper's figures, and of the recommended chain.
typedef std::pair<const char*, const char*> Method;
const Method METHODS[] = {{"Hessian", "IIB UNIVERSAL"}, {"AKAZE", "IIB"}, {"AKAZE", "AKAZE"}, {"ORB", "ORB"},
        {"ORB", "BEBLID-512"}, {"BRISK", "BRISK"}, {"SIFT", "SIFT"}};

//! A row for each mutual match of these methods at the detector's points.
void listMatches(const Options& options, const ImagePair& pair, const Detector& detector, ResultTable& table)
{
    const LoadedPair loaded = loadPair(pair);
    const std::vector<Described> reference = describeAll(detector, loaded.reference, pair.referenceFile),
                                 target = describeAll(detector, loaded.target, pair.targetFile);
    for (size_t i = 0; i < reference.size(); i++)
    {
        const Described &r = reference[i], &t = target[i];
        if (std::none_of(std::begin(METHODS), std::end(METHODS),
                    [&](const Method& m) { return m.first == detector.name && m.second == r.name; }))
            continue;
        const std::vector<cv::DMatch> matches = mutualMatches(r.descriptors, t.descriptors, r.norm);
        const std::vector<bool> correct =
                correctByLocation(matches, r.keypoints, t.keypoints, loaded.homography, options.tolerance);
        for (size_t m = 0; m < matches.size(); m++)
        {
            Fields row = {stem(pair.referenceFile), stem(pair.targetFile), detector.name, r.name};
            for (const cv::Point2f& p :
                    {r.keypoints[matches[m].queryIdx].pt, t.keypoints[matches[m].trainIdx].pt})
                row = with(row, cv::format("%.1f", p.x), cv::format("%.1f", p.y));
            table.append(with(row, int(correct[m])));
        }
    }
}

}  // namespace

int comparison(const Options& options, const std::vector<ImagePair>&)
{
    if (options.compare.empty())
        return 0;
    cv::utils::fs::createDirectories(options.out + "/pictures");
    std::remove((options.out + "/comparison.csv").c_str());
    Experiment experiment(options.out, "comparison",
            {"reference", "target", "detector", "descriptor", "x", "y", "target_x", "target_y", "correct"},
            8);
    Options classic = options;
    classic.detectors = {"Hessian", "AKAZE", "ORB", "BRISK", "SIFT"};
    classic.keypoints.clear();
    for (size_t i = 0; i + 1 < options.compare.size(); i += 2)
    {
        ImagePair pair;
        pair.referenceFile = options.compare[i];
        pair.targetFile = options.compare[i + 1];
        const std::string& target = pair.targetFile;
        const std::string homography =
                cv::utils::fs::join(cv::utils::fs::getParent(target), "H_" + stem(target));
        if (cv::utils::fs::exists(homography))
            pair.homographyFile = homography;
        for (const std::string& image : {pair.referenceFile, pair.targetFile})
        {
            const std::string file = options.out + "/pictures/" + stem(image) + ".jpg";
            if (!cv::imwrite(file, readImage(image, cv::IMREAD_COLOR), {cv::IMWRITE_JPEG_QUALITY, 75}))
                CV_Error(cv::Error::StsError, file + ": cannot be written");
        }
        for (const Detector& detector : detectors(classic))
            experiment.plan({}, stem(target) + " " + detector.name,
                    [&, pair, detector] { listMatches(options, pair, detector, experiment.table); });
    }
    return experiment.run();
}

}  // namespace iib_tools
