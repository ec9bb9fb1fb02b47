// SPDX-License-Identifier: Apache-2.0

#include "configurations.hpp"

#include "opencv2/iib.hpp"

namespace iib_tools {
namespace {

using cv::iib::IIB;

//! IIB with the paper's parameters but for some, on FAST corners.
Configuration iib(const std::string& name, int granularity = 4, int channels = IIB::CHANNELS_DEFAULT,
        int mapping = IIB::MAPPING_MEAN, bool overlap = false, bool oriented = false,
        const std::vector<std::string>& extraNames = std::vector<std::string>())
{
    const int extras = int(extraNames.size());
    const auto create = [=]() -> cv::Ptr<cv::Feature2D> {
        return IIB::create(1.f, granularity, channels, mapping, overlap, oriented, extras);
    };
    return {name, create, 2 * SEED_RADIUS, "FAST", extraNames, oriented};
}

Configuration withChannels(const std::string& name, int channels) { return iib(name, 4, channels); }

Configuration withMapping(const std::string& name, int mapping)
{
    return iib(name, 4, IIB::CHANNELS_DEFAULT, mapping);
}

Configuration withExtras(const std::string& name, const std::vector<std::string>& extraNames)
{
    return iib(name, 4, IIB::CHANNELS_DEFAULT, IIB::MAPPING_MEAN, false, false, extraNames);
}

Configuration withPreset(const std::string& name, int preset)
{
    Configuration c = iib("IIB " + name);
    c.create = [preset]() -> cv::Ptr<cv::Feature2D> { return IIB::createPreset(preset, 1.f); };
    return c;
}

Configuration onPointsOf(const std::string& detector)
{
    Configuration c = iib("IIB on " + detector + " points");
    c.seeds = detector;
    return c;
}

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
              i = IIB::CHANNEL_INTENSITY;
    std::vector<Configuration> all = {iib("IIB"), withChannels("IIB y", y), withChannels("IIB x", x),
            withChannels("IIB i", i), withChannels("IIB o", o), withChannels("IIB o+i", o | i),
            withChannels("IIB x+y", x | y), withChannels("IIB x+y+i", x | y | i),
            withChannels("IIB x+y+o", x | y | o), withMapping("IIB max", IIB::MAPPING_MAX),
            withMapping("IIB min", IIB::MAPPING_MIN), withMapping("IIB quartile", IIB::MAPPING_QUARTILE),
            withMapping("IIB sort", IIB::MAPPING_SORT), withMapping("IIB haar", IIB::MAPPING_HAAR),
            withMapping("IIB pairwise", IIB::MAPPING_PAIRWISE),
            iib("IIB overlap", 4, IIB::CHANNELS_DEFAULT, IIB::MAPPING_MEAN, true), iib("IIB g2", 2),
            iib("IIB g3", 3), iib("IIB g5", 5), withExtras("IIB +depth", {"depth"}),
            withExtras("IIB +labels", {"labels"}), withExtras("IIB +depth+labels", {"depth", "labels"}),
            withExtras("IIB +texture", {TEXTURE}), onPointsOf("AKAZE"), onPointsOf("KAZE")};
    for (const Configuration& c : presetConfigurations())
        all.push_back(c);
    return all;
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
    const size_t start = file.find_last_of('/') + 1;
    Configuration c = iib("IIB " + file.substr(start, file.find_last_of('.') - start));
    c.create = [file]() -> cv::Ptr<cv::Feature2D> {
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

}  // namespace iib_tools
