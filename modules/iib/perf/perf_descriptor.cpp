// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "perf_precomp.hpp"

#include <map>

namespace opencv_test { namespace {

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
    return IIB::create();
}

// In the order of the table in doc/performance.md.
const std::string DESCRIBED[] = {"ORB", "default", "granularity 5", "overlap", "MAX", "QUARTILE", "SORT",
        "HAAR", "PAIRWISE", "PRESET_COMPACT", "PRESET_BALANCED", "PRESET_VIEWPOINT", "PRESET_UNIVERSAL",
        "PRESET_SMALL", EXTRA, "useOrientation"};

typedef perf::TestBaseWithParam<tuple<std::string, int>> IIB_Describe;  // method, points

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

}}  // namespace opencv_test
