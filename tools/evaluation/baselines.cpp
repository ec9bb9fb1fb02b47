// SPDX-License-Identifier: Apache-2.0

#include "configurations.hpp"
#include "opencv2/opencv_modules.hpp"
#if defined(HAVE_OPENCV_XFEATURES2D) || defined(IIB_WITH_CONTRIB)
#define IIB_HAVE_XFEATURES2D
#include "opencv2/xfeatures2d.hpp"
#ifdef IIB_WITH_SURF
#include "opencv2/xfeatures2d/nonfree.hpp"
#endif
#endif

namespace iib_tools {
namespace {

typedef cv::Ptr<cv::Feature2D> Feature;

Configuration baseline(const std::string& name, float seedSize, const std::function<Feature()>& create,
        const std::string& seeds = "FAST")
{
    return {name, create, seedSize, seeds, {}, false};
}

Configuration akaze(int bits)
{
    return baseline(
            "AKAZE-" + std::to_string(bits ? bits : 486), 0,
            [bits]() -> Feature { return cv::AKAZE::create(cv::AKAZE::DESCRIPTOR_MLDB_UPRIGHT, bits); },
            "AKAZE");
}

#ifdef IIB_HAVE_XFEATURES2D
//! As OpenCV's documentation recommends for corners: five times their size, 35 pixels.
const float CORNER_SIZE = 7, CORNER_SCALE = 5;

template <class T>
void addBeblid(const std::string& name, int bits, int size, std::vector<Configuration>& baselines)
{
    const std::string full = name + "-" + std::to_string(bits);
    baselines.push_back(
            baseline(full, 2 * SEED_RADIUS, [size]() -> Feature { return T::create(1.f, size); }));
    baselines.push_back(baseline(
            full + " 5x", CORNER_SIZE, [size]() -> Feature { return T::create(CORNER_SCALE, size); }));
}

void addXfeatures2d(std::vector<Configuration>& baselines)
{
    using namespace cv::xfeatures2d;
    const float side = 2 * SEED_RADIUS;
    for (int bytes : {16, 32, 64})
    {
        baselines.push_back(baseline("BRIEF-" + std::to_string(8 * bytes), side,
                [bytes]() -> Feature { return BriefDescriptorExtractor::create(bytes); }));
        baselines.push_back(baseline("LATCH-" + std::to_string(8 * bytes), side,
                [bytes]() -> Feature { return LATCH::create(bytes, false); }));
    }
    // A pattern of 22 px about keypoints of size 7.
    baselines.push_back(
            baseline("FREAK", 7 * SEED_RADIUS / 22, []() -> Feature { return FREAK::create(false); }));
    addBeblid<BEBLID>("BEBLID", 256, BEBLID::SIZE_256_BITS, baselines);
    addBeblid<BEBLID>("BEBLID", 512, BEBLID::SIZE_512_BITS, baselines);
#if defined(IIB_WITH_CONTRIB) || CV_VERSION_MAJOR * 100 + CV_VERSION_MINOR >= 407
    addBeblid<TEBLID>("TEBLID", 256, TEBLID::SIZE_256_BITS, baselines);
    addBeblid<TEBLID>("TEBLID", 512, TEBLID::SIZE_512_BITS, baselines);
#endif
#ifdef IIB_WITH_SURF
    // The window is 20 times 1.2 / 9 of the size.
    baselines.push_back(baseline(
            "SURF", side * 9 / 24, []() -> Feature { return SURF::create(100, 4, 3, false, true); }));
#endif
    baselines.push_back(baseline("DAISY", side, []() -> Feature { return DAISY::create(SEED_RADIUS); }));
}
#endif

}  // namespace

std::vector<Configuration> baselineConfigurations()
{
    std::vector<Configuration> all = {// Its patch is 31 px whatever the size.
            baseline("ORB", 31, []() -> Feature { return cv::ORB::create(); }),
            // A pattern of 9.2 px about keypoints of size 7.2.
            baseline("BRISK", SEED_RADIUS * 7.2f / 9.2f, []() -> Feature { return cv::BRISK::create(); }),
            // Four bins of 1.5 sizes each.
            baseline("SIFT", 2 * SEED_RADIUS / 6, []() -> Feature { return cv::SIFT::create(); }), akaze(128),
            akaze(256), akaze(0),
            baseline(
                    "KAZE", 0, []() -> Feature { return cv::KAZE::create(false, true); }, "KAZE")};
#ifdef IIB_HAVE_XFEATURES2D
    addXfeatures2d(all);
#endif
    return all;
}

}  // namespace iib_tools
