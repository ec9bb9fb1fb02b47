// SPDX-License-Identifier: Apache-2.0

#include "pair_methods.hpp"

#include "opencv2/iib.hpp"
#include "opencv2/iib/views.hpp"

namespace iib_tools {
namespace {

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
