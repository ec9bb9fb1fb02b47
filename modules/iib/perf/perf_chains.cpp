// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// Comparison of methods, as programs use them.

#include "perf_precomp.hpp"

#ifdef IIB_PERF_XFEATURES2D
#include "opencv2/xfeatures2d.hpp"
#endif

namespace opencv_test { namespace {

typedef perf::TestBaseWithParam<tuple<std::string, int>> IIB_Describe;  // method, size

#ifdef IIB_PERF_XFEATURES2D
// As IIB_Describe_hd.
PERF_TEST_P(IIB_Describe, contrib,
        testing::Combine(testing::Values("BEBLID-256", "BEBLID-512", "TEBLID-512", "LATCH-512"),
                testing::Values(1000, 5000)))
{
    using namespace cv::xfeatures2d;
    const std::string name = get<0>(GetParam());
    const Mat image = cornerImage(Size(1280, 720));
    const std::vector<KeyPoint> points = corners(image, get<1>(GetParam()));
    Ptr<Feature2D> feature = LATCH::create(64, false);
    if (name == "TEBLID-512")
        feature = TEBLID::create(1.f, TEBLID::SIZE_512_BITS);
    else if (name != "LATCH-512")
        feature = BEBLID::create(1.f, name == "BEBLID-256" ? BEBLID::SIZE_256_BITS : BEBLID::SIZE_512_BITS);
    std::vector<KeyPoint> keypoints;
    Mat descriptors;
    const Threads one(1);
    TEST_CYCLE()
    {
        keypoints = points;
        feature->compute(image, keypoints, descriptors);
    }
    SANITY_CHECK_NOTHING();
}
#endif

// 1000 points; the image's sides in eighths of 6000 x 4000 pixels.
PERF_TEST_P(IIB_Describe, large,
        testing::Combine(testing::Values("ORB", "default"), testing::Values(1, 2, 3, 4, 6, 8)))
{
    const Mat image = cornerImage(Size(750, 500) * get<1>(GetParam()));
    std::vector<KeyPoint> keypoints = corners(image, 1000);
    const Ptr<Feature2D> feature =
            get<0>(GetParam()) == "ORB" ? Ptr<Feature2D>(ORB::create()) : Ptr<Feature2D>(IIB::create());
    Mat descriptors;
    const Threads one(1);
    TEST_CYCLE() feature->compute(image, keypoints, descriptors);
    SANITY_CHECK_NOTHING();
}

#if CV_VERSION_MAJOR < 5
const std::string SAME[] = {"IIB", "AKAZE", "ORB",
#ifdef IIB_PERF_XFEATURES2D
        "BEBLID-512 5x"
#endif
};

typedef perf::TestBaseWithParam<std::string> IIB_DescribeAkaze;

// AKAZE's points, each descriptor on about the same region.
PERF_TEST_P(IIB_DescribeAkaze, street, testing::ValuesIn(SAME))
{
    const Mat image = picture("street_noon");
    const Ptr<Feature2D> akaze = AKAZE::create(AKAZE::DESCRIPTOR_MLDB_UPRIGHT);
    Ptr<Feature2D> feature = akaze;
    if (GetParam() == "IIB")
        feature = IIB::createFor(akaze);
    else if (GetParam() == "ORB")
        feature = ORB::create();
#ifdef IIB_PERF_XFEATURES2D
    else if (GetParam() == "BEBLID-512 5x")  // for corners that have the detector's own size
        feature = xfeatures2d::BEBLID::create(5.f, xfeatures2d::BEBLID::SIZE_512_BITS);
#endif
    std::vector<KeyPoint> points, keypoints;
    akaze->detect(image, points);
    KeyPointsFilter::retainBest(points, 1000);
    RecordProperty("points", (int)points.size());
    Mat descriptors;
    const Threads one(1);
    TEST_CYCLE()
    {
        keypoints = points;
        feature->compute(image, keypoints, descriptors);
    }
    SANITY_CHECK_NOTHING();
}
#endif

//! Detects and describes.
struct Chain
{
    Ptr<Feature2D> detector, descriptor;

    Chain(const std::string& name, int points)
    {
        if (name == "recommended chain")
            detector = HessianDetector::create(points);
        else if (name == "SIFT")
            detector = SIFT::create(points);
#if CV_VERSION_MAJOR < 5
        else if (name == "AKAZE")
            detector = AKAZE::create(AKAZE::DESCRIPTOR_MLDB_UPRIGHT);
        else if (name == "BRISK")
            detector = BRISK::create();
        else if (name == "KAZE")
            detector = KAZE::create(false, true);
#endif
        else
            detector = ORB::create(points);
        descriptor = detector;
        if (name == "recommended chain")
            descriptor = IIB::createFor(detector, IIB::PRESET_UNIVERSAL);
        else if (name == "IIB at ORB's points")
            descriptor = IIB::createFor(detector);
    }

    void run(const Mat& image)
    {
        if (detector == descriptor)
            return detector->detectAndCompute(image, noArray(), keypoints, descriptors);
        detector->detect(image, keypoints);
        descriptor->compute(image, keypoints, descriptors);
    }

    std::vector<KeyPoint> keypoints;
    Mat descriptors;
};

class IIB_Chain
    : public perf::TestBaseWithParam<tuple<std::string, std::string, int>>  // picture, method, points
{
protected:
    void time()
    {
        const Mat image = picture(get<0>(GetParam()));
        Chain chain(get<1>(GetParam()), get<2>(GetParam()));
        const Threads one(1);
        TEST_CYCLE() chain.run(image);
        RecordProperty("points", (int)chain.keypoints.size());
        SANITY_CHECK_NOTHING();
    }
};

PERF_TEST_P(IIB_Chain, vga,
        testing::Combine(testing::Values("scene", "street_noon"), testing::Values("ORB", "recommended chain"),
                testing::Values(1000, 2000)))
{
    time();
}

const std::string OTHERS[] = {"IIB at ORB's points", "SIFT",
#if CV_VERSION_MAJOR < 5
        "BRISK", "AKAZE", "KAZE"
#endif
};

PERF_TEST_P(IIB_Chain, others,
        testing::Combine(testing::Values("street_noon"), testing::ValuesIn(OTHERS), testing::Values(1000)))
{
    time();
}

}}  // namespace opencv_test
