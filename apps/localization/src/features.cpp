// SPDX-License-Identifier: Apache-2.0

#include "features.hpp"

#include "opencv2/iib.hpp"

namespace iib_localization {
namespace {

using namespace cv::iib;

constexpr int MAX_KEYPOINTS = 2000;

std::vector<cv::DMatch> matchEuclidean(const cv::Mat& query, const cv::Mat& train, float maxRatio)
{
    cv::Mat q, t;
    query.convertTo(q, CV_32F);
    train.convertTo(t, CV_32F);
    const cv::BFMatcher matcher(cv::NORM_L2);
    std::vector<std::vector<cv::DMatch>> nearest;
    std::vector<cv::DMatch> back, matches;
    matcher.knnMatch(q, t, nearest, 2);
    matcher.match(t, q, back);
    for (const std::vector<cv::DMatch>& n : nearest)
        if (back[n[0].trainIdx].trainIdx == n[0].queryIdx &&
                (n.size() < 2 || n[0].distance < maxRatio * n[1].distance))
            matches.push_back(n[0]);
    return matches;
}

}  // namespace

FeatureMethod::FeatureMethod(const std::string& name) : name_(name)
{
    if (name == "iib")
        detectors_ = {IIB::createRecommended(MAX_KEYPOINTS)};
    else if (name == "sift")
        detectors_ = {NormalizedDetector::create(cv::SIFT::create(MAX_KEYPOINTS))};
    else if (name == "own")
        detectors_ = {NormalizedDetector::create(cv::ORB::create(MAX_KEYPOINTS / 2)),
                NormalizedDetector::create(cv::AKAZE::create())};
    else
        CV_Error(cv::Error::StsBadArg, "features '" + name + "' are not one of iib, own and sift");
}

std::string FeatureMethod::description() const
{
    return name_ == "iib" ? "iib recommended 1" : name_;  // another number for other bits or points
}

Features FeatureMethod::extract(const cv::Mat& grey) const
{
    Features features;
    for (const cv::Ptr<cv::Feature2D>& detector : detectors_)
    {
        std::vector<cv::KeyPoint> keypoints;
        cv::Mat codes;
        detector->detect(grey, keypoints);
        std::stable_sort(keypoints.begin(), keypoints.end(),
                [](const cv::KeyPoint& a, const cv::KeyPoint& b) { return a.response > b.response; });
        if (keypoints.size() > MAX_KEYPOINTS / detectors_.size())
            keypoints.resize(MAX_KEYPOINTS / detectors_.size());
        detector->compute(grey, keypoints, codes);
        codes.convertTo(codes, CV_8U);  // SIFT's are whole numbers up to 255
        for (const cv::KeyPoint& k : keypoints)
            features.pixels.push_back(k.pt);
        features.codes.push_back(codes);
    }
    return features;
}

std::vector<cv::DMatch> FeatureMethod::match(const cv::Mat& query, const cv::Mat& train, float maxRatio) const
{
    std::vector<cv::DMatch> matches;
    if (query.empty() || train.empty())
        return matches;
    if (!binary())
        return matchEuclidean(query, train, maxRatio);
    const cv::Ptr<HierarchicalMatcher> matcher = HierarchicalMatcher::create();
    matcher->setCrossCheck(true);
    matcher->setMaxRatio(maxRatio);
    matcher->match(query, train, matches);
    return matches;
}

std::vector<cv::DMatch> FeatureMethod::match(const Features& a, const Features& b, float maxRatio) const
{
    std::vector<cv::DMatch> all;
    int firstA = 0, firstB = 0;  // of the detector
    for (size_t d = 0; d < detectors(); d++)
    {
        for (const cv::DMatch& m : match(a.codes[d], b.codes[d], maxRatio))
            all.emplace_back(firstA + m.queryIdx, firstB + m.trainIdx, m.distance);
        firstA += a.codes[d].rows;
        firstB += b.codes[d].rows;
    }
    return all;
}

}  // namespace iib_localization
