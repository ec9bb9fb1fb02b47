// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#ifndef OPENCV_IIB_DEMO_PIPELINE_HPP
#define OPENCV_IIB_DEMO_PIPELINE_HPP

#include "iib_demo_options.hpp"

#include "opencv2/calib3d.hpp"
#include "opencv2/core/utility.hpp"
#include "opencv2/iib.hpp"
#include "opencv2/opencv_modules.hpp"

#include <map>

#if CV_VERSION_MAJOR >= 5 || defined(HAVE_OPENCV_XFEATURES2D)
#include "opencv2/xfeatures2d.hpp"
#endif

static const int MAX_KEYPOINTS = 1000;
static const double MAX_ERROR = 3;  // pixels, in image B
// MAGSAC's homography agrees with up to 6 of 20 to 2000 matches drawn at random; fewer than these say nothing.
static const int MIN_CONSISTENT = 10;

struct Detector
{
    cv::Ptr<cv::Feature2D> feature;
    bool describes;  // has a descriptor of its own
};

struct Pair
{
    cv::Mat images[2];
    std::string detector;
    std::vector<cv::KeyPoint> keypoints[2];
    double detectMs = 0;
};

struct Result
{
    std::string name;
    int bytes = 0;
    std::vector<cv::KeyPoint> keypoints[2];  // a descriptor may reorder or drop some
    std::vector<cv::DMatch> matches;
    bool judged = false;      // there is a homography, given or estimated
    std::vector<uchar> good;  // one a match: within MAX_ERROR of that homography
    double describeMs = 0, matchMs = 0, verifyMs = 0;

    int goodCount() const { return good.empty() ? 0 : cv::countNonZero(good); }
    double precision() const { return matches.empty() ? 0 : (double)goodCount() / matches.size(); }
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
#if CV_VERSION_MAJOR >= 5
    using namespace cv::xfeatures2d;  // where OpenCV 5 has AGAST, AKAZE, BRISK and KAZE
#endif
    using namespace cv;
    if (name == "HESSIAN")
        return Detector{iib::HessianDetector::create(MAX_KEYPOINTS), false};
    if (name == "FAST")
        return Detector{FastFeatureDetector::create(), false};
    if (name == "AGAST")
        return Detector{AgastFeatureDetector::create(), false};
    if (name == "GFTT")
        return Detector{GFTTDetector::create(MAX_KEYPOINTS), false};
    if (name == "MSER")
        return Detector{MSER::create(), false};
    if (name == "SimpleBlob")
        return Detector{SimpleBlobDetector::create(), false};
    if (name == "ORB")
        return Detector{ORB::create(MAX_KEYPOINTS), true};
    if (name == "BRISK")
        return Detector{BRISK::create(), true};
    if (name == "AKAZE")
        return Detector{AKAZE::create(), true};
    if (name == "KAZE")
        return Detector{KAZE::create(), true};
    if (name == "SIFT")
        return Detector{SIFT::create(MAX_KEYPOINTS), true};
#if defined(HAVE_OPENCV_XFEATURES2D) && defined(OPENCV_ENABLE_NONFREE)
    return Detector{xfeatures2d::SURF::create(), true};
#else
    throw UserError("this OpenCV has no SURF, which needs xfeatures2d built with OPENCV_ENABLE_NONFREE");
#endif
}

inline cv::Ptr<cv::Feature2D> createIIB(const Options& options)
{
    using cv::iib::IIB;
    static const std::map<std::string, int> presets = {{"S128", IIB::PRESET_S128}, {"S256", IIB::PRESET_S256},
            {"S512", IIB::PRESET_S512}, {"ACCURATE", IIB::PRESET_ACCURATE}, {"COMPACT", IIB::PRESET_COMPACT},
            {"TINY", IIB::PRESET_TINY}, {"BALANCED", IIB::PRESET_BALANCED},
            {"VIEWPOINT", IIB::PRESET_VIEWPOINT}, {"UNIVERSAL", IIB::PRESET_UNIVERSAL},
            {"SMALL", IIB::PRESET_SMALL}};
    const float factor = IIB::scaleFactorFor(options.detector);
    const cv::Ptr<IIB> iib = options.preset == "default"
                                     ? IIB::create(factor, options.granularity)
                                     : IIB::createPreset(presets.at(options.preset), factor);
    iib->setOrientation(options.orientation == "keypoint"   ? IIB::ORIENTATION_KEYPOINT
                        : options.orientation == "gradient" ? IIB::ORIENTATION_GRADIENT
                                                            : IIB::ORIENTATION_NONE);
    return iib;
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
    for (int i = 0; i < 2; i++)
        if (pair.keypoints[i].empty())
            throw UserError(pair.detector + " finds no keypoint in image " + "AB"[i]);
}

//! What is recommended, for binary descriptors of any kind; for others mutual nearest neighbours.
inline cv::Ptr<cv::DescriptorMatcher> createMatcher(const cv::Ptr<cv::Feature2D>& descriptor)
{
    if (descriptor->descriptorType() != CV_8U)
        return cv::makePtr<cv::BFMatcher>(descriptor->defaultNorm(), true);
    return cv::iib::HierarchicalMatcher::createRecommended();
}

//! H: from image A to B; empty: the one that MAGSAC finds in the matches themselves, if there is one.
inline void verify(const cv::Mat& H, Result& result)
{
    std::vector<cv::Point2f> a, b, projected;
    for (const cv::DMatch& m : result.matches)
    {
        a.push_back(result.keypoints[0][m.queryIdx].pt);
        b.push_back(result.keypoints[1][m.trainIdx].pt);
    }
    result.good.assign(a.size(), 0);
    cv::Mat model = H;
    if (model.empty() && a.size() >= 4)
        model = cv::findHomography(a, b, cv::USAC_MAGSAC, MAX_ERROR);
    if (!a.empty() && !model.empty())
        cv::perspectiveTransform(a, projected, model);
    for (size_t i = 0; i < projected.size(); i++)
        result.good[i] = cv::norm(projected[i] - b[i]) <= MAX_ERROR;
    result.judged = !H.empty() || result.goodCount() >= MIN_CONSISTENT;
    if (!result.judged)
        result.good.assign(a.size(), 0);
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
