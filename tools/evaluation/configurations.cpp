// SPDX-License-Identifier: Apache-2.0

#include "configurations.hpp"

#include "opencv2/iib.hpp"

namespace iib_tools {
namespace {

using cv::iib::IIB;

struct Parameters
{
    int granularity = 4, channels = IIB::CHANNELS_DEFAULT, mapping = IIB::MAPPING_MEAN;
    bool overlap = false;
};

Configuration iib(const std::string& name, const Parameters& p,
        const std::vector<std::string>& extraNames = std::vector<std::string>())
{
    Configuration c;
    c.name = name;
    const int extras = int(extraNames.size());
    c.create = [p, extras]() -> cv::Ptr<cv::Feature2D> {
        return IIB::create(1.f, p.granularity, p.channels, p.mapping, p.overlap, false, extras);
    };
    c.seedSize = 2 * SEED_RADIUS;
    c.seeds = "FAST";
    c.extraNames = extraNames;
    c.oriented = false;
    return c;
}

Configuration withChannels(const std::string& name, int channels)
{
    Parameters p;
    p.channels = channels;
    return iib(name, p);
}

Configuration withMapping(const std::string& name, int mapping)
{
    Parameters p;
    p.mapping = mapping;
    return iib(name, p);
}

Configuration withGranularity(int granularity)
{
    Parameters p;
    p.granularity = granularity;
    return iib("IIB g" + std::to_string(granularity), p);
}

Configuration withOverlap()
{
    Parameters p;
    p.overlap = true;
    return iib("IIB overlap", p);
}

Configuration withPreset(const std::string& name, int preset)
{
    Configuration c = iib("IIB " + name, Parameters());
    c.create = [preset]() -> cv::Ptr<cv::Feature2D> { return IIB::createPreset(preset, 1.f); };
    return c;
}

Configuration onPointsOf(Configuration c, const std::string& detector)
{
    c.name += " on " + detector + " points";
    c.seeds = detector;
    return c;
}

}  // namespace

std::vector<Configuration> presetConfigurations()
{
    return {withPreset("S128", IIB::PRESET_S128), withPreset("S256", IIB::PRESET_S256),
            withPreset("S512", IIB::PRESET_S512), withPreset("ACCURATE", IIB::PRESET_ACCURATE),
            withPreset("COMPACT", IIB::PRESET_COMPACT), withPreset("TINY", IIB::PRESET_TINY),
            withPreset("BALANCED", IIB::PRESET_BALANCED), withPreset("VIEWPOINT", IIB::PRESET_VIEWPOINT),
            withPreset("UNIVERSAL", IIB::PRESET_UNIVERSAL), withPreset("SMALL", IIB::PRESET_SMALL)};
}

std::vector<Configuration> iibConfigurations()
{
    const int x = IIB::CHANNEL_GRAD_X, y = IIB::CHANNEL_GRAD_Y, o = IIB::CHANNEL_ORIENTATION,
              i = IIB::CHANNEL_INTENSITY;
    const Configuration standard = iib("IIB", Parameters());
    std::vector<Configuration> all = {standard, withChannels("IIB y", y), withChannels("IIB x", x),
            withChannels("IIB i", i), withChannels("IIB o", o), withChannels("IIB o+i", o | i),
            withChannels("IIB x+y", x | y), withChannels("IIB x+y+i", x | y | i),
            withChannels("IIB x+y+o", x | y | o), withMapping("IIB max", IIB::MAPPING_MAX),
            withMapping("IIB min", IIB::MAPPING_MIN), withMapping("IIB quartile", IIB::MAPPING_QUARTILE),
            withMapping("IIB sort", IIB::MAPPING_SORT), withMapping("IIB haar", IIB::MAPPING_HAAR),
            withMapping("IIB pairwise", IIB::MAPPING_PAIRWISE), withOverlap(), withGranularity(2),
            withGranularity(3), withGranularity(5), iib("IIB +depth", Parameters(), {"depth"}),
            iib("IIB +labels", Parameters(), {"labels"}),
            iib("IIB +depth+labels", Parameters(), {"depth", "labels"}), onPointsOf(standard, "AKAZE"),
            onPointsOf(standard, "KAZE")};
    const std::vector<Configuration> learned = presetConfigurations();
    all.insert(all.end(), learned.begin(), learned.end());
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
    Configuration upright = iib("IIB", Parameters());
    Configuration oriented = upright;
    oriented.name = "IIB oriented";
    oriented.oriented = true;
    oriented.create = []() -> cv::Ptr<cv::Feature2D> {
        return IIB::create(1.f, 4, IIB::CHANNELS_DEFAULT, IIB::MAPPING_MEAN, false, true);
    };
    std::vector<Configuration> all = presetConfigurations();
    all.insert(all.begin(), {upright, oriented});
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
    Configuration c = iib("IIB " + file.substr(start, file.find_last_of('.') - start), Parameters());
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

cv::Ptr<cv::Feature2D> defaultIIB(float scaleFactor) { return IIB::create(scaleFactor); }

Description describe(const Configuration& configuration, const cv::Mat& image,
        const std::vector<cv::Mat>& extras, const std::vector<cv::KeyPoint>& keypoints)
{
    Description d;
    d.keypoints = keypoints;
    const cv::Ptr<cv::Feature2D> feature = configuration.create();
    if (configuration.extraNames.empty())
        feature->compute(image, d.keypoints, d.descriptors);
    else
        feature.dynamicCast<IIB>()->compute(image, extras, d.keypoints, d.descriptors);
    return d;
}

int descriptorBytes(const cv::Feature2D& feature)
{
    return feature.descriptorSize() * int(CV_ELEM_SIZE1(feature.descriptorType()));
}

}  // namespace iib_tools
