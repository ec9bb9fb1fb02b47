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

void writePicture(const std::string& file, const cv::Mat& picture)
{
    if (!cv::imwrite(file, picture, {cv::IMWRITE_JPEG_QUALITY, 75}))
        CV_Error(cv::Error::StsError, file + ": cannot be written");
}

//! Points of a detector, and what describes them.
struct Method
{
    std::string detector, descriptor;
};

//! Those of the paper's figures, and the recommended chain.
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
                    [&](const Method& m) { return m.detector == detector.name && m.descriptor == r.name; }))
            continue;
        const std::vector<cv::DMatch> matches = mutualMatches(r.descriptors, t.descriptors, r.norm);
        const std::vector<bool> correct =
                correctByLocation(matches, r.keypoints, t.keypoints, loaded.homography, options.tolerance);
        for (size_t m = 0; m < matches.size(); m++)
        {
            const cv::Point2f a = r.keypoints[matches[m].queryIdx].pt,
                              b = t.keypoints[matches[m].trainIdx].pt;
            table.append({stem(pair.referenceFile), stem(pair.targetFile), detector.name, r.name,
                    cv::format("%.1f", a.x), cv::format("%.1f", a.y), cv::format("%.1f", b.x),
                    cv::format("%.1f", b.y), correct[m] ? "1" : "0"});
        }
    }
}

}  // namespace

int comparison(const Options& options, const std::vector<ImagePair>&)
{
    if (options.compare.empty())
        return 0;
    cv::utils::fs::createDirectories(options.out + "/pictures");
    const std::string file = options.out + "/comparison.csv";
    std::remove(file.c_str());
    ResultTable table(file,
            {"reference", "target", "detector", "descriptor", "x", "y", "target_x", "target_y", "correct"},
            8);
    Options classic = options;
    classic.detectors = {"Hessian", "AKAZE", "ORB", "BRISK", "SIFT"};
    classic.keypoints.clear();
    std::vector<Task> tasks;
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
            writePicture(
                    options.out + "/pictures/" + stem(image) + ".jpg", readImage(image, cv::IMREAD_COLOR));
        for (const Detector& detector : detectors(classic))
            tasks.push_back({stem(target) + " " + detector.name,
                    [&, pair, detector] { listMatches(options, pair, detector, table); }});
    }
    return runTasks("comparison", tasks, &table);
}

}  // namespace iib_tools
