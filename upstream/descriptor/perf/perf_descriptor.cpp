// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "perf_precomp.hpp"

namespace opencv_test { namespace {

//! Corners everywhere: blurred noise at two scales.
Mat cornerImage(Size size)
{
    RNG rng(1);
    Mat fine(size, CV_8U), coarse(size / 8, CV_8U), image;
    rng.fill(fine, RNG::UNIFORM, 0, 256);
    rng.fill(coarse, RNG::UNIFORM, 0, 256);
    GaussianBlur(fine, fine, Size(5, 5), 1.);
    resize(coarse, coarse, size, 0, 0, INTER_CUBIC);
    addWeighted(fine, 0.5, coarse, 0.5, 0, image);
    return image;
}

//! FAST corners with ORB's size, away from the border, where ORB would drop them.
std::vector<KeyPoint> corners(const Mat& image, size_t count)
{
    std::vector<KeyPoint> all, chosen;
    FAST(image, all, 5);
    const Rect inside(64, 64, image.cols - 128, image.rows - 128);
    const size_t step = std::max<size_t>(all.size() / (2 * count), 1);
    for (size_t i = 0; i < all.size() && chosen.size() < count; i += step)
        if (inside.contains(all[i].pt))
        {
            chosen.push_back(all[i]);
            chosen.back().size = 31;
        }
    return chosen;
}

Ptr<Feature2D> create(const std::string& name)
{
    if (name == "ORB")
        return ORB::create();
    if (name == "BEBLID-512")
    {
#ifdef IIB_PERF_XFEATURES2D
        return xfeatures2d::BEBLID::create(1.f);
#else
        throw SkipTestException("needs xfeatures2d");
#endif
    }
    const int mapping = name == "IIB QUARTILE" ? IIB::MAPPING_QUARTILE
                        : name == "IIB SORT"   ? IIB::MAPPING_SORT
                                               : IIB::MAPPING_MEAN;
    return IIB::create(2.f, 4, IIB::CHANNELS_DEFAULT, mapping, name == "IIB overlap");
}

typedef perf::TestBaseWithParam<tuple<std::string, int>> IIB_Describe;  // what, points

PERF_TEST_P(IIB_Describe, hd,
        testing::Combine(
                testing::Values("ORB", "BEBLID-512", "IIB", "IIB QUARTILE", "IIB SORT", "IIB overlap"),
                testing::Values(1000, 5000)))
{
    const Mat image = cornerImage(Size(1280, 720));
    const std::vector<KeyPoint> points = corners(image, get<1>(GetParam()));
    ASSERT_EQ((size_t)get<1>(GetParam()), points.size());
    const Ptr<Feature2D> feature = create(get<0>(GetParam()));
    Mat descriptors;
    setNumThreads(1);
    TEST_CYCLE()
    {
        std::vector<KeyPoint> keypoints = points;
        feature->compute(image, keypoints, descriptors);
    }
    SANITY_CHECK_NOTHING();
}

}}  // namespace opencv_test
