// SPDX-License-Identifier: Apache-2.0

#include "configurations.hpp"

#include "common/dataset.hpp"
#include "opencv2/iib.hpp"
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

using cv::iib::IIB;
typedef cv::Ptr<cv::Feature2D> Feature;

//! IIB on FAST corners, with the paper's parameters except for the given ones.
Configuration iib(const std::string& name, int granularity = 4, int channels = IIB::CHANNELS_DEFAULT,
        int mapping = IIB::MAPPING_MEAN, bool overlap = false, bool oriented = false,
        const std::vector<std::string>& extraNames = std::vector<std::string>())
{
    const int extras = int(extraNames.size());
    const auto create = [=]() -> Feature {
        return IIB::create(1.f, granularity, channels, mapping, overlap, oriented, extras);
    };
    return {name, create, 2 * SEED_RADIUS, "FAST", extraNames, oriented};
}

Configuration withPreset(const std::string& name, int preset)
{
    Configuration c = iib("IIB " + name);
    c.create = [preset]() -> Feature { return IIB::createPreset(preset, 1.f); };
    return c;
}

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
//! OpenCV's documentation recommends five times the size of corners, 35 pixels.
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
    // The pattern is 22 px wide at keypoints of size 7.
    baselines.push_back(
            baseline("FREAK", 7 * SEED_RADIUS / 22, []() -> Feature { return FREAK::create(false); }));
    addBeblid<BEBLID>("BEBLID", 256, BEBLID::SIZE_256_BITS, baselines);
    addBeblid<BEBLID>("BEBLID", 512, BEBLID::SIZE_512_BITS, baselines);
#if defined(IIB_WITH_CONTRIB) || CV_VERSION_MAJOR * 100 + CV_VERSION_MINOR >= 407
    addBeblid<TEBLID>("TEBLID", 256, TEBLID::SIZE_256_BITS, baselines);
    addBeblid<TEBLID>("TEBLID", 512, TEBLID::SIZE_512_BITS, baselines);
#endif
#ifdef IIB_WITH_SURF
    // The window is 20 * 1.2 / 9 times the size.
    baselines.push_back(baseline(
            "SURF", side * 9 / 24, []() -> Feature { return SURF::create(100, 4, 3, false, true); }));
#endif
    baselines.push_back(baseline("DAISY", side, []() -> Feature { return DAISY::create(SEED_RADIUS); }));
}
#endif

}  // namespace

std::vector<Configuration> presetConfigurations()
{
    std::vector<Configuration> all = {withPreset("S128", IIB::PRESET_S128),
            withPreset("S256", IIB::PRESET_S256), withPreset("S512", IIB::PRESET_S512),
            withPreset("TINY", IIB::PRESET_TINY)};
    for (const Configuration& c : generalPresets())
        all.push_back(c);
    return all;
}

std::vector<Configuration> iibConfigurations()
{
    const int x = IIB::CHANNEL_GRAD_X, y = IIB::CHANNEL_GRAD_Y, o = IIB::CHANNEL_ORIENTATION,
              i = IIB::CHANNEL_INTENSITY, all = IIB::CHANNELS_DEFAULT, mean = IIB::MAPPING_MEAN;
    std::vector<Configuration> found = {iib("IIB"), iib("IIB y", 4, y), iib("IIB x", 4, x),
            iib("IIB i", 4, i), iib("IIB o", 4, o), iib("IIB o+i", 4, o | i), iib("IIB x+y", 4, x | y),
            iib("IIB x+y+i", 4, x | y | i), iib("IIB x+y+o", 4, x | y | o),
            iib("IIB max", 4, all, IIB::MAPPING_MAX), iib("IIB min", 4, all, IIB::MAPPING_MIN),
            iib("IIB quartile", 4, all, IIB::MAPPING_QUARTILE), iib("IIB sort", 4, all, IIB::MAPPING_SORT),
            iib("IIB haar", 4, all, IIB::MAPPING_HAAR), iib("IIB pairwise", 4, all, IIB::MAPPING_PAIRWISE),
            iib("IIB overlap", 4, all, mean, true), iib("IIB g2", 2), iib("IIB g3", 3), iib("IIB g5", 5)};
    for (const std::vector<std::string>& extras :
            std::vector<std::vector<std::string>>{{"depth"}, {"labels"}, {"depth", "labels"}, {TEXTURE}})
        found.push_back(iib("IIB +" + extras[0] + (extras.size() > 1 ? "+" + extras[1] : ""), 4, all, mean,
                false, false, extras));
    for (const char* detector : {"AKAZE", "KAZE"})
    {
        found.push_back(iib(std::string("IIB on ") + detector + " points"));
        found.back().seeds = detector;
    }
    for (const Configuration& c : presetConfigurations())
        found.push_back(c);
    return found;
}

std::vector<Configuration> generalPresets()
{
    return {withPreset("ACCURATE", IIB::PRESET_ACCURATE), withPreset("COMPACT", IIB::PRESET_COMPACT),
            withPreset("BALANCED", IIB::PRESET_BALANCED), withPreset("VIEWPOINT", IIB::PRESET_VIEWPOINT),
            withPreset("UNIVERSAL", IIB::PRESET_UNIVERSAL), withPreset("SMALL", IIB::PRESET_SMALL)};
}

std::vector<Configuration> robustnessConfigurations()
{
    std::vector<Configuration> all = {
            iib("IIB"), iib("IIB oriented", 4, IIB::CHANNELS_DEFAULT, IIB::MAPPING_MEAN, false, true)};
    for (const Configuration& c : presetConfigurations())
        all.push_back(c);
    for (const Configuration& baseline : baselineConfigurations())
        if (baseline.name == "BEBLID-512" || baseline.name == "TEBLID-512" || baseline.name == "LATCH-512")
            all.push_back(baseline);
        else if (baseline.name == "ORB" || baseline.name == "SIFT")
        {
            all.push_back(baseline);
            all.push_back(baseline);
            all.back().name += " oriented";
            all.back().oriented = true;
        }
    return all;
}

Configuration savedConfiguration(const std::string& file)
{
    Configuration c = iib("IIB " + stem(file));
    c.create = [file]() -> Feature {
        cv::Ptr<IIB> extractor = IIB::create();
        const cv::FileStorage storage(file, cv::FileStorage::READ);
        if (!storage.isOpened())
            CV_Error(cv::Error::StsObjectNotFound, file + ": cannot be read");
        extractor->read(storage.getFirstTopLevelNode());
        extractor->setScaleFactor(1.f);
        return extractor;
    };
    return c;
}

int descriptorBytes(const cv::Feature2D& feature)
{
    return feature.descriptorSize() * int(CV_ELEM_SIZE1(feature.descriptorType()));
}

std::vector<Configuration> baselineConfigurations()
{
    std::vector<Configuration> all = {// Its patch is 31 px for every size.
            baseline("ORB", 31, []() -> Feature { return cv::ORB::create(); }),
            // The pattern is 9.2 px wide at keypoints of size 7.2.
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
