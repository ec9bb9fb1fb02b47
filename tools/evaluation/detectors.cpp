// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "detectors.hpp"

#include <algorithm>
#include <tuple>

#include "deep_keypoints.hpp"
#include "common/keypoints.hpp"
#include "opencv2/iib.hpp"

namespace iib_tools {
namespace {

typedef cv::Ptr<cv::Feature2D> Feature;

//! Upright, without the copies that several orientations made, the strongest first and no more than count.
void selectStrongest(std::vector<cv::KeyPoint>& keypoints, int count)
{
    for (cv::KeyPoint& keypoint : keypoints)
        keypoint.angle = 0;
    cv::KeyPointsFilter::removeDuplicated(keypoints);
    const auto order = [](const cv::KeyPoint& k) {
        return std::make_tuple(-k.response, k.pt.y, k.pt.x, k.size);
    };
    std::stable_sort(keypoints.begin(), keypoints.end(),
            [&](const cv::KeyPoint& a, const cv::KeyPoint& b) { return order(a) < order(b); });
    keypoints.resize(std::min(keypoints.size(), size_t(count)));
}

//! The descriptor may drop keypoints; IIB is then given the same ones.
Detector classic(const std::string& name, const std::string& descriptorName,
        const std::function<Feature()>& detector, const std::function<Feature()>& descriptor, int count)
{
    const auto detect = [=](const cv::Mat& image, const ImagePair&, const std::string&) {
        Detection d;
        detector()->detect(image, d.keypoints);
        selectStrongest(d.keypoints, count);
        const Feature own = descriptor();
        own->compute(image, d.keypoints, d.descriptors);
        d.norm = own->defaultNorm();
        return d;
    };
    return {name, descriptorName, cv::iib::IIB::scaleFactorFor(name), detect};
}

Detector classic(const std::string& name, const std::function<Feature()>& feature, int count)
{
    return classic(name, name, feature, feature, count);
}

//! Keypoints without a scale, such as learned detectors give: one size, and a ROS of radius DEEP_RADIUS.
void giveDeepSize(std::vector<cv::KeyPoint>& keypoints)
{
    for (cv::KeyPoint& keypoint : keypoints)
        keypoint.size = 2 * DEEP_RADIUS;
}

Detector fromFiles(const std::string& folder, int count)
{
    const auto detect = [=](const cv::Mat&, const ImagePair& pair, const std::string& imageFile) {
        const size_t start = imageFile.find_last_of('/') + 1;
        const std::string image = imageFile.substr(start, imageFile.find('.', start) - start);
        Detection d;
        d.keypoints = readKeypoints(folder + "/" + pair.set + "/" + pair.sequence + "/" + image + ".csv");
        selectStrongest(d.keypoints, count);
        giveDeepSize(d.keypoints);
        d.norm = 0;
        return d;
    };
    return {"file", "", 1.f, detect};
}

Detector fromNetwork(const std::string& file, int count)
{
    const cv::Ptr<DeepDetector> network = cv::makePtr<DeepDetector>(file);
    const auto detect = [=](const cv::Mat& image, const ImagePair&, const std::string&) {
        const DeepKeypoints found = network->detect(image, count);
        Detection d = {found.keypoints, found.descriptors, cv::NORM_L2};
        giveDeepSize(d.keypoints);
        return d;
    };
    return {"network", network->hasDescriptors() ? "network" : "", 1.f, detect};
}

}  // namespace

std::vector<Detector> detectors(const Options& options)
{
    const int count = options.points;
    const auto orb = [count]() -> Feature { return cv::ORB::create(count); };
    const auto akaze = []() -> Feature { return cv::AKAZE::create(cv::AKAZE::DESCRIPTOR_MLDB_UPRIGHT); };
    std::vector<Detector> all = {
            classic(
                    "FAST", "ORB", []() -> Feature { return cv::FastFeatureDetector::create(); }, orb, count),
            classic(
                    "AGAST", "ORB", []() -> Feature { return cv::AgastFeatureDetector::create(); }, orb,
                    count),
            classic("ORB", orb, count),
            classic(
                    "BRISK", []() -> Feature { return cv::BRISK::create(); }, count),
            classic("AKAZE", akaze, count),
            classic(
                    "KAZE", []() -> Feature { return cv::KAZE::create(false, true); }, count),
            classic(
                    "SIFT", []() -> Feature { return cv::SIFT::create(); }, count)};
    for (const Configuration& baseline : baselineConfigurations())
        if (baseline.name == "SURF")
            all.push_back(classic("SURF", baseline.create, count));
    if (!options.keypoints.empty())
        all.push_back(fromFiles(options.keypoints, count));
    if (!options.network.empty())
        all.push_back(fromNetwork(options.network, count));
    return all;
}

}  // namespace iib_tools
