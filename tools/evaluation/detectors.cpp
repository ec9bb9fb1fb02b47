// SPDX-License-Identifier: Apache-2.0

#include "detectors.hpp"

#include <algorithm>
#include <fstream>
#include <tuple>

#include "common/fnv1a.hpp"
#include "common/keypoints.hpp"
#include "common/npy.hpp"
#include "deep_keypoints.hpp"
#include "opencv2/core/utils/filesystem.hpp"
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

//! The descriptor may drop keypoints; the others are then given the same ones.
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
    return {name, descriptorName, cv::iib::IIB::scaleFactorFor(name), detect, {}};
}

//! Found on the locally normalized image; the plain image is described.
Detector normalized(const std::string& name, const std::string& descriptorName,
        const std::function<Feature()>& detector, const std::function<Feature()>& descriptor, int count)
{
    const auto wrapped = [detector]() -> Feature { return cv::iib::NormalizedDetector::create(detector()); };
    Detector d = classic(name, descriptorName, wrapped, descriptor, count);
    d.name += " normalized";
    return d;
}

//! The library's own, which describes nothing.
Detector hessian(const std::string& name, int count)
{
    const auto detect = [=](const cv::Mat& image, const ImagePair&, const std::string&) {
        Detection d;
        cv::iib::HessianDetector::create(count)->detect(image, d.keypoints);
        d.norm = 0;  // no descriptors
        return d;
    };
    return {name, "", cv::iib::IIB::scaleFactorFor("Hessian"), detect, {}};
}

//! A detector that gives no size gets a ROS of radius DEEP_RADIUS.
void giveMissingSizes(std::vector<cv::KeyPoint>& keypoints)
{
    for (cv::KeyPoint& keypoint : keypoints)
        if (!(keypoint.size > 0))
            keypoint.size = 2 * DEEP_RADIUS;
}

/** Keypoints of a detector from `<set>/<sequence>/<image>.csv` below the folder, and its own descriptors, row by row,
from the file beside it that ends with .npy, if there is one. */
Detector fromFiles(const KeypointFolder& source, int count)
{
    const auto detect = [=](const cv::Mat&, const ImagePair& pair, const std::string& imageFile) {
        const size_t start = imageFile.find_last_of('/') + 1;
        const std::string image = imageFile.substr(start, imageFile.find('.', start) - start);
        const std::string file = source.folder + "/" + pair.set + "/" + pair.sequence + "/" + image;
        Detection d;
        d.keypoints = readKeypoints(file + ".csv");
        for (size_t i = 0; i < d.keypoints.size(); i++)
            d.keypoints[i].class_id = int(i);
        const size_t all = d.keypoints.size();
        giveMissingSizes(d.keypoints);
        selectStrongest(d.keypoints, count);
        d.norm = 0;  // no descriptors
        if (!cv::utils::fs::exists(file + ".npy"))
            return d;
        const cv::Mat rows = readNpy(file + ".npy");
        if (size_t(rows.rows) != all)
            CV_Error(cv::Error::StsUnmatchedSizes,
                    cv::format("%s.npy: %d rows for %d keypoints", file.c_str(), rows.rows, int(all)));
        d.descriptors.create(0, rows.cols, rows.type());
        for (const cv::KeyPoint& k : d.keypoints)
            d.descriptors.push_back(rows.row(k.class_id));
        d.norm = rows.type() == CV_32F ? int(cv::NORM_L2) : int(cv::NORM_HAMMING);
        return d;
    };
    return {source.name, source.name, 1.f, detect, {}};
}

Detector fromNetwork(const std::string& file, int count)
{
    const cv::Ptr<DeepDetector> network = cv::makePtr<DeepDetector>(file);
    const auto detect = [=](const cv::Mat& image, const ImagePair&, const std::string&) {
        const DeepKeypoints found = network->detect(image, count);
        Detection d = {found.keypoints, found.descriptors, cv::NORM_L2};
        for (cv::KeyPoint& keypoint : d.keypoints)
            keypoint.size = 2 * DEEP_RADIUS;
        return d;
    };
    return {"network", network->hasDescriptors() ? "network" : "", 1.f, detect, {}};
}

//! What people describe ORB's points with instead; the patches that have a fixed size are of about ORB's.
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
    for (const auto& k : known)
        all.push_back(normalized(k.name, k.descriptor, k.detector, k.own, count));
    all.push_back(hessian("Hessian", count));
    all.push_back(hessian("Hessian x2", 2 * count));  // twice as many points
    for (const Configuration& baseline : baselineConfigurations())
        if (baseline.name == "SURF")
            all.push_back(classic("SURF", "SURF", baseline.create, baseline.create, count));
    return all;
}

Described describeWith(
        const std::string& name, const Feature& feature, const Detection& detection, const cv::Mat& image)
{
    Described d = {name, detection.keypoints, cv::Mat(), feature->defaultNorm(), descriptorBytes(*feature)};
    feature->compute(image, d.keypoints, d.descriptors);
    return d;
}

void addFile(const std::string& file, cv::iib::Fnv1a& hash)
{
    std::ifstream in(file, std::ios::binary);
    if (!in)
        CV_Error(cv::Error::StsObjectNotFound, file + ": cannot be read");
    const std::string bytes((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());
    hash.add(bytes.data(), bytes.size());
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
    for (const KeypointFolder& source : options.keypoints)
        chosen.push_back(fromFiles(source, options.points));
    if (!options.network.empty())
        chosen.push_back(fromNetwork(options.network, options.points));
    return chosen;
}

std::vector<std::string> describedNames(const Detector& detector)
{
    std::vector<std::string> names;
    for (const Configuration& c : detector.others)
        names.push_back(c.name);
    for (const Configuration& c : generalPresets())
        names.push_back(c.name);
    names.push_back("IIB");
    return names;
}

std::vector<Described> describeAll(const Detector& detector, const Detection& detection, const cv::Mat& image)
{
    std::vector<Described> all;
    if (!detector.descriptor.empty() && detection.norm != 0)
        all.push_back({detector.descriptor, detection.keypoints, detection.descriptors, detection.norm,
                int(detection.descriptors.cols * detection.descriptors.elemSize())});
    for (const Configuration& c : detector.others)
        all.push_back(describeWith(c.name, c.create(), detection, image));
    for (const Configuration& c : generalPresets())
    {
        const cv::Ptr<cv::iib::IIB> iib = c.create().dynamicCast<cv::iib::IIB>();
        iib->setScaleFactor(iib->getScaleFactor() * detector.scaleFactor);  // a preset may look wider
        all.push_back(describeWith(c.name, iib, detection, image));
    }
    all.push_back(describeWith("IIB", defaultIIB(detector.scaleFactor), detection, image));
    return all;
}

std::vector<std::pair<std::string, std::string>> digests(const Options& options)
{
    std::vector<std::pair<std::string, std::string>> found;
    for (const KeypointFolder& source : options.keypoints)
    {
        std::vector<cv::String> files;
        cv::utils::fs::glob_relative(source.folder, "", files, true);
        std::sort(files.begin(), files.end());
        cv::iib::Fnv1a hash;
        for (const std::string& file : files)
        {
            hash.add(file.c_str(), file.size() + 1);
            addFile(source.folder + "/" + file, hash);
        }
        if (files.empty())
            CV_Error(cv::Error::StsObjectNotFound, source.folder + ": no files of keypoints");
        found.push_back(
                {"keypoints " + source.name, cv::format("%016llx", (unsigned long long)hash.value())});
    }
    if (!options.network.empty())
    {
        cv::iib::Fnv1a hash;
        addFile(options.network, hash);
        found.push_back({"network", cv::format("%016llx", (unsigned long long)hash.value())});
    }
    return found;
}

}  // namespace iib_tools
