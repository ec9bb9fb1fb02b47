// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "perf_precomp.hpp"

#ifdef IIB_PERF_XFEATURES2D
#include "opencv2/xfeatures2d.hpp"
#endif

namespace opencv_test {
namespace {

const std::string EXTRA = "2 extra channels";

Ptr<Feature2D> create(const std::string& name)
{
    const int all = IIB::CHANNELS_DEFAULT, mean = IIB::MAPPING_MEAN;
    const std::map<std::string, int> mappings = {{"MAX", IIB::MAPPING_MAX},
            {"QUARTILE", IIB::MAPPING_QUARTILE}, {"SORT", IIB::MAPPING_SORT}, {"HAAR", IIB::MAPPING_HAAR},
            {"PAIRWISE", IIB::MAPPING_PAIRWISE}};
    const std::map<std::string, int> presets = {{"PRESET_COMPACT", IIB::PRESET_COMPACT},
            {"PRESET_BALANCED", IIB::PRESET_BALANCED}, {"PRESET_VIEWPOINT", IIB::PRESET_VIEWPOINT},
            {"PRESET_UNIVERSAL", IIB::PRESET_UNIVERSAL}, {"PRESET_SMALL", IIB::PRESET_SMALL}};
    if (mappings.count(name))
        return IIB::create(2.f, 4, all, mappings.at(name));
    if (presets.count(name))
        return IIB::createPreset(presets.at(name));
    if (name == "granularity 5")
        return IIB::create(2.f, 5);
    if (name == "overlap")
        return IIB::create(2.f, 4, all, mean, true);
    if (name == EXTRA)
        return IIB::create(2.f, 4, all, mean, false, false, 2);
    if (name == "useOrientation")
        return IIB::create(2.f, 4, all, mean, false, true);
    if (name == "ORB")
        return ORB::create();
#ifdef IIB_PERF_XFEATURES2D
    using namespace cv::xfeatures2d;
    if (name == "BEBLID-256")
        return BEBLID::create(1.f, BEBLID::SIZE_256_BITS);
    if (name == "BEBLID-512")
        return BEBLID::create(1.f, BEBLID::SIZE_512_BITS);
    if (name == "BEBLID-512 5x")  // for corners that have the detector's own size
        return BEBLID::create(5.f, BEBLID::SIZE_512_BITS);
    if (name == "TEBLID-512")
        return TEBLID::create(1.f, TEBLID::SIZE_512_BITS);
    if (name == "LATCH-512")
        return LATCH::create(64, false);
#endif
#if CV_VERSION_MAJOR < 5
    if (name == "AKAZE")
        return AKAZE::create(AKAZE::DESCRIPTOR_MLDB_UPRIGHT);
#endif
    return IIB::create();
}

// In the order of the table in doc/performance.md; ORB, BEBLID, TEBLID and LATCH are peers.
const std::string DESCRIBED[] = {"ORB", "default", "granularity 5", "overlap", "MAX", "QUARTILE", "SORT",
        "HAAR", "PAIRWISE", "PRESET_COMPACT", "PRESET_BALANCED", "PRESET_VIEWPOINT", "PRESET_UNIVERSAL",
        "PRESET_SMALL", EXTRA, "useOrientation",
#ifdef IIB_PERF_XFEATURES2D
        "BEBLID-256", "BEBLID-512", "TEBLID-512", "LATCH-512"
#endif
};

typedef perf::TestBaseWithParam<tuple<std::string, int>> IIB_Describe;  // what, points

PERF_TEST_P(IIB_Describe, hd, testing::Combine(testing::ValuesIn(DESCRIBED), testing::Values(1000, 5000)))
{
    const std::string name = get<0>(GetParam());
    const Mat image = cornerImage(Size(1280, 720));
    const std::vector<KeyPoint> points = corners(image, get<1>(GetParam()));
    const Ptr<Feature2D> feature = create(name);
    std::vector<KeyPoint> keypoints;
    Mat descriptors;
    const Threads one(1);
    if (name == EXTRA)
    {
        const std::vector<Mat> maps(2, image);
        const Ptr<IIB> iib = feature.dynamicCast<IIB>();
        TEST_CYCLE()
        {
            keypoints = points;
            iib->compute(image, maps, keypoints, descriptors);
        }
    }
    else
        TEST_CYCLE()
        {
            keypoints = points;
            feature->compute(image, keypoints, descriptors);
        }
    SANITY_CHECK_NOTHING();
}

PERF_TEST_P(IIB_Describe, hd_on_two_threads,
        testing::Combine(testing::Values("default"), testing::Values(1, 1000, 5000)))
{
    const Mat image = cornerImage(Size(1280, 720));
    std::vector<KeyPoint> keypoints = corners(image, get<1>(GetParam()));
    const Ptr<IIB> iib = IIB::create();
    Mat descriptors;
    const Threads two(2);
    TEST_CYCLE() iib->compute(image, keypoints, descriptors);
    SANITY_CHECK_NOTHING();
}

// 1000 points; the image's sides in eighths of 6000 x 4000 pixels.
PERF_TEST_P(IIB_Describe, large,
        testing::Combine(testing::Values("ORB", "default"), testing::Values(1, 2, 3, 4, 6, 8)))
{
    const Mat image = cornerImage(Size(750, 500) * get<1>(GetParam()));
    std::vector<KeyPoint> keypoints = corners(image, 1000);
    const Ptr<Feature2D> feature = create(get<0>(GetParam()));
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
    const Ptr<Feature2D> akaze = create("AKAZE");
    const Ptr<Feature2D> feature =
            GetParam() == "IIB" ? Ptr<Feature2D>(IIB::createFor(akaze)) : create(GetParam());
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

}  // namespace
}  // namespace opencv_test
