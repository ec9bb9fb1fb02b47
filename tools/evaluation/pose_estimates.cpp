// SPDX-License-Identifier: Apache-2.0
#include "pose_estimates.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "opencv2/calib3d.hpp"
#include "opencv2/iib.hpp"
#include "opencv2/iib/relative_pose.hpp"
#include "opencv2/iib/views.hpp"

namespace iib_tools {
namespace {

const double CONFIDENCE = 0.9999;
const float RATIO_IIB = 0.92f, RATIO_BITS = 0.9f, RATIO_FLOAT = 0.8f;  // nearest distance over the second
const double FAILED = std::numeric_limits<double>::infinity();

//! Converts pixels to directions in the camera's axes, third coordinate 1.
std::vector<cv::Point2d> normalizedPoints(const std::vector<cv::Point2d>& points, const cv::Matx33d& camera)
{
    std::vector<cv::Point2d> rays;
    for (const cv::Point2d& p : points)
        rays.push_back({(p.x - camera(0, 2)) / camera(0, 0), (p.y - camera(1, 2)) / camera(1, 1)});
    return rays;
}

double degrees(double cosine) { return std::acos(std::max(-1., std::min(1., cosine))) * 180 / CV_PI; }

//! The larger one of the errors in degrees of rotation and of the direction of the translation.
double poseError(const cv::Mat& rotation, const cv::Mat& translation, const ViewPair& pair)
{
    const cv::Matx33d rest = cv::Matx33d(rotation).t() * pair.rotation;
    const cv::Vec3d found(translation);
    const double direction =
            degrees(found.dot(pair.translation) / cv::norm(found) / cv::norm(pair.translation));
    return std::max(degrees((cv::trace(rest) - 1) / 2), direction);
}

bool searched(const cv::Mat& image1, const cv::Mat& image2, int count, Points& points)
{
    cv::Mat points1, points2;
    const bool found = cv::iib::matchViews(
            image1, image2, points1, points2, cv::noArray(), cv::noArray(), cv::noArray(), count);
    points1.reshape(2).convertTo(points.reference, CV_64F);
    points2.reshape(2).convertTo(points.target, CV_64F);
    return found;
}

Described describe(const cv::Ptr<cv::Feature2D>& feature, const cv::Mat& image)
{
    Described d = {"", {}, cv::Mat(), feature->defaultNorm(), 0};
    feature->detectAndCompute(image, cv::noArray(), d.keypoints, d.descriptors);
    return d;
}

PairMethod featureMethod(
        const std::string& name, const std::function<cv::Ptr<cv::Feature2D>()>& create, bool slow = false)
{
    return {name, slow, [create](const cv::Mat& image1, const cv::Mat& image2, Points& points) {
                const cv::Ptr<cv::Feature2D> feature = create();
                const Described one = describe(feature, image1), two = describe(feature, image2);
                points = pointsOf(mutualRatioMatches(one, two), one, two);
                return true;
            }};
}

}  // namespace

std::vector<cv::DMatch> mutualMatches(
        const Described& reference, const Described& target, std::vector<float>& ratios)
{
    std::vector<cv::DMatch> kept;
    ratios.clear();
    if (reference.descriptors.empty() || target.descriptors.rows < 2)
        return kept;
    const cv::BFMatcher matcher(reference.norm);
    std::vector<std::vector<cv::DMatch>> nearest;
    std::vector<cv::DMatch> back;
    matcher.knnMatch(reference.descriptors, target.descriptors, nearest, 2);
    matcher.match(target.descriptors, reference.descriptors, back);
    for (const std::vector<cv::DMatch>& two : nearest)
        if (back[two[0].trainIdx].trainIdx == two[0].queryIdx)
        {
            kept.push_back(two[0]);
            ratios.push_back(two[1].distance > 0 ? two[0].distance / two[1].distance : 1);
        }
    return kept;
}

std::vector<cv::DMatch> underRatio(
        const std::vector<cv::DMatch>& matches, const std::vector<float>& ratios, float most)
{
    std::vector<cv::DMatch> kept;
    for (size_t i = 0; i < matches.size(); i++)
        if (ratios[i] < most)
            kept.push_back(matches[i]);
    return kept;
}

std::vector<cv::DMatch> mutualRatioMatches(const Described& reference, const Described& target)
{
    std::vector<float> ratios;
    const std::vector<cv::DMatch> matches = mutualMatches(reference, target, ratios);
    const float bits = reference.name.rfind("IIB", 0) == 0 ? RATIO_IIB : RATIO_BITS;
    return underRatio(matches, ratios, reference.norm == cv::NORM_HAMMING ? bits : RATIO_FLOAT);
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

Points refined(const cv::Mat& referenceImage, const cv::Mat& targetImage, std::vector<cv::DMatch> matches,
        const Described& reference, const Described& target, bool propagated)
{
    Points points;
    if (matches.empty())
        return points;
    std::vector<cv::KeyPoint> first = reference.keypoints, second = target.keypoints;
    for (std::vector<cv::KeyPoint>* keypoints : {&first, &second})
        for (cv::KeyPoint& keypoint : *keypoints)
            keypoint.angle = -1;  // upright
    cv::Mat moved1, moved2;
    if (propagated)
        cv::iib::propagateMatches(referenceImage, first, targetImage, second, matches, moved1, moved2);
    else
        cv::iib::refineMatches(referenceImage, first, targetImage, second, matches, moved1, moved2);
    moved1.reshape(2).convertTo(points.reference, CV_64F);
    moved2.reshape(2).convertTo(points.target, CV_64F);
    return points;
}

Outcome byFindRelativePose(const Points& points, const ViewPair& pair)
{
    cv::Mat rotation, translation, mask;
    if (!cv::iib::findRelativePose(points.reference, points.target, pair.referenceCamera, pair.targetCamera,
                rotation, translation, mask))
        return {FAILED, 0};
    return {poseError(rotation, translation, pair), cv::countNonZero(mask)};
}

Outcome byMagsac(const Points& points, const ViewPair& pair, double threshold)
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
    return {poseError(rotation, translation, pair), inliers};
}

std::vector<PairMethod> pairMethods(int count)
{
    const auto chain = [count](const cv::Mat& image1, const cv::Mat& image2, Points& points) {
        const cv::Ptr<cv::Feature2D> feature = cv::iib::IIB::createRecommended(count);
        const Described one = describe(feature, image1), two = describe(feature, image2);
        std::vector<cv::DMatch> matches;
        if (!one.descriptors.empty() && !two.descriptors.empty())
            cv::iib::HierarchicalMatcher::createRecommended()->match(
                    one.descriptors, two.descriptors, matches);
        points = refined(image1, image2, matches, one, two, true);
        return true;
    };
    const auto sift = [count]() -> cv::Ptr<cv::Feature2D> { return cv::SIFT::create(count); };
    return {{"matchViews", false,
                    [count](const cv::Mat& image1, const cv::Mat& image2, Points& points) {
                        return searched(image1, image2, count, points);
                    }},
            {"upright chain", false, chain}, featureMethod("SIFT", sift),
            featureMethod("ORB", [count]() -> cv::Ptr<cv::Feature2D> { return cv::ORB::create(count); }),
            featureMethod(
                    "AffineFeature", [sift] { return cv::AffineFeature::create(sift()); }, true)};
}

}  // namespace iib_tools
