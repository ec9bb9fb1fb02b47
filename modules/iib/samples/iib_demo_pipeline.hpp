// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#ifndef OPENCV_IIB_DEMO_PIPELINE_HPP
#define OPENCV_IIB_DEMO_PIPELINE_HPP

#include "iib_demo_options.hpp"

#include "opencv2/calib3d.hpp"
#include "opencv2/core/utility.hpp"
#include "opencv2/iib.hpp"

static const int MAX_KEYPOINTS = 2000;
static const double MAX_ERROR = 3;  // pixels, in image B

struct Detector
{
    cv::Ptr<cv::Feature2D> feature;
    bool describes;  // has a descriptor of its own
};

struct Pair
{
    cv::Mat images[2];
    std::vector<cv::KeyPoint> keypoints[2];
    double detectMs = 0;
};

struct Result
{
    std::string name;
    int bytes = 0;
    std::vector<cv::KeyPoint> keypoints[2];  // a descriptor may reorder or drop some
    std::vector<cv::DMatch> matches;
    std::vector<uchar> correct;  // one a match
    double describeMs = 0, matchMs = 0, verifyMs = 0;

    int correctCount() const { return correct.empty() ? 0 : cv::countNonZero(correct); }
    double precision() const { return matches.empty() ? 0 : (double)correctCount() / matches.size(); }
};

template <typename Step> double milliseconds(const Step& step)
{
    cv::TickMeter timer;
    timer.start();
    step();
    timer.stop();
    return timer.getTimeMilli();
}

inline Detector createDetector(const std::string& name)
{
    if (name == "FAST")
        return Detector{cv::FastFeatureDetector::create(), false};
    if (name == "AGAST")
        return Detector{cv::AgastFeatureDetector::create(), false};
    if (name == "GFTT")
        return Detector{cv::GFTTDetector::create(MAX_KEYPOINTS), false};
    if (name == "ORB")
        return Detector{cv::ORB::create(MAX_KEYPOINTS), true};
    if (name == "BRISK")
        return Detector{cv::BRISK::create(), true};
    if (name == "AKAZE")
        return Detector{cv::AKAZE::create(), true};
    if (name == "KAZE")
        return Detector{cv::KAZE::create(), true};
    if (name == "SIFT")
        return Detector{cv::SIFT::create(MAX_KEYPOINTS), true};
    throw UserError("--detector takes FAST, AGAST, ORB, BRISK, AKAZE, KAZE, SIFT or GFTT, not " + name);
}

inline cv::Ptr<cv::Feature2D> createIIB(const Options& options)
{
    return cv::iib::IIB::create(cv::iib::IIB::scaleFactorFor(options.detector), options.granularity);
}

inline void detect(const Detector& detector, Pair& pair)
{
    pair.detectMs = milliseconds([&] {
        for (int i = 0; i < 2; i++)
        {
            detector.feature->detect(pair.images[i], pair.keypoints[i]);
            cv::KeyPointsFilter::retainBest(pair.keypoints[i], MAX_KEYPOINTS);
        }
    });
}

//! Mutual nearest neighbours.
inline cv::Ptr<cv::DescriptorMatcher> createMatcher(const cv::Ptr<cv::Feature2D>& descriptor)
{
    if (descriptor->descriptorType() != CV_8U)
        return cv::makePtr<cv::BFMatcher>(descriptor->defaultNorm(), true);
    cv::Ptr<cv::iib::IIB> iib = descriptor.dynamicCast<cv::iib::IIB>();
    const std::vector<int> levels =
            iib ? iib->levelSizes() : std::vector<int>(1, descriptor->descriptorSize());
    return cv::iib::HierarchicalMatcher::create(levels, cv::iib::HierarchicalMatcher::EXACT, 0.35f, true);
}

//! H: from image A to B; empty: the one that MAGSAC finds in the matches themselves.
inline void verify(const cv::Mat& H, Result& result)
{
    std::vector<cv::Point2f> a, b, projected;
    for (const cv::DMatch& m : result.matches)
    {
        a.push_back(result.keypoints[0][m.queryIdx].pt);
        b.push_back(result.keypoints[1][m.trainIdx].pt);
    }
    result.correct.assign(a.size(), 0);
    cv::Mat model = H;
    if (model.empty() && a.size() >= 4)
        model = cv::findHomography(a, b, cv::USAC_MAGSAC, MAX_ERROR);
    if (a.empty() || model.empty())
        return;
    cv::perspectiveTransform(a, projected, model);
    for (size_t i = 0; i < a.size(); i++)
        result.correct[i] = cv::norm(projected[i] - b[i]) <= MAX_ERROR;
}

inline Result matchPair(
        const std::string& name, const cv::Ptr<cv::Feature2D>& descriptor, const Pair& pair, const cv::Mat& H)
{
    Result result;
    result.name = name;
    cv::Mat descriptors[2];
    result.describeMs = milliseconds([&] {
        for (int i = 0; i < 2; i++)
        {
            result.keypoints[i] = pair.keypoints[i];
            descriptor->compute(pair.images[i], result.keypoints[i], descriptors[i]);
        }
    });
    result.bytes = descriptors[0].cols * (int)descriptors[0].elemSize();
    const cv::Ptr<cv::DescriptorMatcher> matcher = createMatcher(descriptor);
    result.matchMs = milliseconds([&] { matcher->match(descriptors[0], descriptors[1], result.matches); });
    result.verifyMs = milliseconds([&] { verify(H, result); });
    return result;
}

#endif
