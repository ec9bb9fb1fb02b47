// SPDX-License-Identifier: Apache-2.0

#include "detectors.hpp"

#include <algorithm>
#include <tuple>

#include "common/keypoints.hpp"
#include "opencv2/core/utils/filesystem.hpp"
#include "opencv2/iib.hpp"

namespace iib_tools {
namespace {

typedef cv::Ptr<cv::Feature2D> Feature;

//! Keeps the `count` strongest keypoints, upright, strongest first. Removes copies with several orientations.
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

//! A detector and its own descriptor. If this drops keypoints, the other descriptors do not get them either.
Detector classic(const std::string& name, const std::string& descriptorName,
        const std::function<Feature()>& detector, const std::function<Feature()>& descriptor, int count)
{
    const auto detect = [=](const cv::Mat& image, const std::string&) {
        Detection d;
        detector()->detect(image, d.keypoints);
        selectStrongest(d.keypoints, count);
        const Feature own = descriptor();
        own->compute(image, d.keypoints, d.descriptors);
        d.norm = own->defaultNorm();
        return d;
    };
    return {name, descriptorName, cv::iib::IIB::scaleFactorFor(name), detect, {}, ""};
}

//! Detects on the locally normalized image and describes the plain image.
Detector normalized(const std::string& name, const std::string& descriptorName,
        const std::function<Feature()>& detector, const std::function<Feature()>& descriptor, int count)
{
    const auto wrapped = [detector]() -> Feature { return cv::iib::NormalizedDetector::create(detector()); };
    Detector d = classic(name, descriptorName, wrapped, descriptor, count);
    d.name += " normalized";
    return d;
}

//! HessianDetector, which has no descriptor of its own.
Detector hessian(const std::string& name, int count)
{
    const auto detect = [=](const cv::Mat& image, const std::string&) {
        Detection d = {};
        cv::iib::HessianDetector::create(count)->detect(image, d.keypoints);
        return d;
    };
    return {name, "", cv::iib::IIB::scaleFactorFor("Hessian"), detect, {}, ""};
}

//! The list of an image's keypoints below a folder: `<set>/<sequence>/<image>.csv`.
std::string keypointFile(const std::string& folder, const std::string& imageFile)
{
    size_t start = imageFile.size();
    for (int i = 0; i < 3 && start > 0 && start != std::string::npos; i++)
        start = imageFile.find_last_of('/', start - 1);
    const std::string name = start == std::string::npos ? "/" + imageFile : imageFile.substr(start);
    return folder + name.substr(0, name.find_last_of('.')) + ".csv";
}

//! A detector whose keypoints are in files, perhaps with descriptors.
Detector fromFiles(const std::string& folder, int count)
{
    const auto detect = [=](const cv::Mat&, const std::string& imageFile) {
        Detection d = {{}, cv::Mat(), cv::NORM_L2};
        cv::Mat rows;
        readKeypoints(keypointFile(folder, imageFile), d.keypoints, rows);
        for (size_t i = 0; i < d.keypoints.size(); i++)
            d.keypoints[i].class_id = int(i);
        selectStrongest(d.keypoints, count);
        for (const cv::KeyPoint& k : d.keypoints)
            if (!rows.empty())
                d.descriptors.push_back(rows.row(k.class_id));
        return d;
    };
    const std::string trimmed = folder.substr(0, folder.find_last_not_of('/') + 1),
                      name = trimmed.substr(trimmed.find_last_of('/') + 1);
    return {name, name, 1.f, detect, {}, trimmed};
}

//! Other descriptors of ORB's points; those with a fixed patch have about the size of ORB's.
std::vector<Configuration> othersOnORB()
{
    std::vector<Configuration> others;
    for (const Configuration& c : baselineConfigurations())
        for (const char* name : {"BEBLID-512", "TEBLID-512", "LATCH-512", "BRIEF-512", "FREAK"})
            if (c.name == name)
                others.push_back(c);
    return others;
}

std::vector<Detector> classicDetectors(int count)
{
    const auto fast = []() -> Feature { return cv::FastFeatureDetector::create(); };
    const auto agast = []() -> Feature { return cv::AgastFeatureDetector::create(); };
    const auto orb = [count]() -> Feature { return cv::ORB::create(count); };
    const auto brisk = []() -> Feature { return cv::BRISK::create(); };
    const auto akaze = []() -> Feature { return cv::AKAZE::create(cv::AKAZE::DESCRIPTOR_MLDB_UPRIGHT); };
    const auto kaze = []() -> Feature { return cv::KAZE::create(false, true); };
    const auto sift = []() -> Feature { return cv::SIFT::create(); };
    const struct
    {
        const char *name, *descriptor;
        std::function<Feature()> detector, own;
    } known[] = {{"FAST", "ORB", fast, orb}, {"AGAST", "ORB", agast, orb}, {"ORB", "ORB", orb, orb},
            {"BRISK", "BRISK", brisk, brisk}, {"AKAZE", "AKAZE", akaze, akaze}, {"KAZE", "KAZE", kaze, kaze},
            {"SIFT", "SIFT", sift, sift}};
    std::vector<Detector> all;
    for (const auto& k : known)
    {
        all.push_back(classic(k.name, k.descriptor, k.detector, k.own, count));
        if (all.back().name == "ORB")
            all.back().others = othersOnORB();
    }
    for (const Configuration& c : baselineConfigurations())
        if (c.name == "SURF")
            all.push_back(classic("SURF", "SURF", c.create, c.create, count));
    for (const auto& k : known)
        all.push_back(normalized(k.name, k.descriptor, k.detector, k.own, count));
    all.push_back(hessian("Hessian", count));
    all.push_back(hessian("Hessian x2", 2 * count));  // twice as many points
    return all;
}

//! The descriptors of a detector's points except its own: Detector::others, the presets, and last the default.
std::vector<Configuration> describersOf(const Detector& detector)
{
    std::vector<Configuration> all = detector.others;
    for (const Configuration& c : generalPresets())
        all.push_back(c);
    all.push_back(iibConfigurations().front());
    return all;
}

}  // namespace

std::vector<Detector> detectors(const Options& options)
{
    std::vector<Detector> all = classicDetectors(options.points), chosen;
    std::string known;
    for (const Detector& d : all)
        known += (known.empty() ? "" : ", ") + d.name;
    for (const std::string& name : options.detectors)
    {
        const auto found =
                std::find_if(all.begin(), all.end(), [&](const Detector& d) { return d.name == name; });
        if (found == all.end())
            CV_Error(cv::Error::StsBadArg, "unknown detector " + name + "; there are " + known);
        chosen.push_back(*found);
    }
    if (options.detectors.empty())
        chosen = all;
    for (const std::string& folder : options.keypoints)
        chosen.push_back(fromFiles(folder, options.points));
    return chosen;
}

bool Detector::knows(const std::string& imageFile) const
{
    return folder.empty() || cv::utils::fs::exists(keypointFile(folder, imageFile));
}

std::vector<Described> describeAll(const Detector& detector, const cv::Mat& image, const std::string& file)
{
    const Detection detection = detector.detect(image, file);
    std::vector<Described> all;
    if (!detector.descriptor.empty() && (detector.folder.empty() || !detection.descriptors.empty()))
        all.push_back({detector.descriptor, detection.keypoints, detection.descriptors, detection.norm,
                int(detection.descriptors.cols * detection.descriptors.elemSize())});
    for (const Configuration& c : describersOf(detector))
    {
        const Feature feature = c.create();
        const cv::Ptr<cv::iib::IIB> iib = feature.dynamicCast<cv::iib::IIB>();
        if (iib)
            iib->setScaleFactor(
                    iib->getScaleFactor() * detector.scaleFactor);  // a preset may have a wider region
        Described d = {
                c.name, detection.keypoints, cv::Mat(), feature->defaultNorm(), descriptorBytes(*feature)};
        feature->compute(image, d.keypoints, d.descriptors);
        all.push_back(d);
    }
    return all;
}

}  // namespace iib_tools
