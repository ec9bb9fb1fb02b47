// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "parameters.hpp"

namespace cv { namespace iib {

namespace {

struct LearnedSelection
{
    float scale;  //!< factor of the user's scale factor
    int granularity, channels, mapping;
    const char* masks;  //!< encoded masks of all places; null: all bits
};

#include "presets.generated.hpp"

//! The argument of setSelection().
Mat selectionOf(const LearnedSelection& p)
{
    const Parameters all = {1.f, p.granularity, p.channels, p.mapping, true, 0, 0, 0, Mat_<int>()};
    std::vector<int> masks, quads;
    for (const char* c = p.masks; *c; c++)
        if (*c > 'v')
            masks.resize(masks.size() + (2 << (*c - 'w')), 0);
        else
            masks.push_back(*c - (*c <= '9' ? '0' : 'a' - 10));
    const int* mask = masks.data();
    for (int level = 1; level <= p.granularity; level++)
        forEachPlace(all, level, [&](int channel, int row, int col, int) {
            if (*mask)
                quads.insert(quads.end(), {level, channel, row, col, *mask});
            mask++;
        });
    return Mat(quads, true).reshape(1, (int)quads.size() / 5);
}

}  // namespace

Ptr<IIBDescriptorExtractor> IIBDescriptorExtractor::createPreset(int preset, float scaleFactor)
{
    const int presets = int(sizeof(PRESETS) / sizeof(PRESETS[0]));
    if (preset < 0 || preset >= presets)
        CV_Error(Error::StsBadArg,
                format("preset is %d; it must be one of the PRESET_ values, 0 to %d", preset, presets - 1));
    const LearnedSelection& p = PRESETS[preset];
    const Ptr<IIBDescriptorExtractor> extractor =
            create(p.scale * scaleFactor, p.granularity, p.channels, p.mapping);
    if (p.masks)
        extractor->setSelection(selectionOf(p));
    return extractor;
}

namespace {

struct DetectorScale
{
    const char* name;
    float scaleFactor;
};

/* AKAZE to SURF: paper, "Experiments Combined with Feature Detectors". FAST, AGAST (size 7) and GFTT (size 3) find corners of
 one size: a region of 64 pixels, as in "Predefined Feature Points". MSER and SimpleBlob give the diameters of blobs; the
 region includes their surroundings. HessianDetector: most correct matches of PRESET_UNIVERSAL (16 and 20 are as good). */
const DetectorScale detectorScales[] = {{"akaze", 12.f}, {"orb", 2.f}, {"brisk", 4.f}, {"sift", 20.f},
        {"kaze", 20.f}, {"surf", 4.f}, {"fast", 64.f / 7}, {"agast", 64.f / 7}, {"gftt", 64.f / 3},
        {"mser", 2.f}, {"simpleblob", 4.f}, {"hessian", 18.f}};

}  // namespace

float IIBDescriptorExtractor::scaleFactorFor(const String& detectorName)
{
    String name;
    for (size_t i = 0; i < detectorName.size(); i++)
        name += (char)tolower((unsigned char)detectorName[i]);
    name = name.substr(name.rfind('.') == String::npos ? 0 : name.rfind('.') + 1);
    // names of OpenCV's classes, such as FastFeatureDetector
    for (const char* ending : {"featuredetector", "detector"})
    {
        const size_t at = name.rfind(ending);
        if (at != String::npos && at > 0 && at + strlen(ending) == name.size())
            name.resize(at);
    }

    String known;
    for (const DetectorScale& d : detectorScales)
    {
        if (name == d.name)
            return d.scaleFactor;
        known += String(known.empty() ? "" : ", ") + d.name;
    }
    CV_Error(Error::StsBadArg, "no scale factor is known for the detector \"" + detectorName +
                                       "\", only for " + known +
                                       "; give create() the ROS side divided by KeyPoint::size, and the "
                                       "detector to setDetector()");
}

float IIBDescriptorExtractor::scaleFactorFor(const char* detectorName)
{
    if (!detectorName)
        CV_Error(Error::StsNullPtr, "the detector's name is null");
    return scaleFactorFor(String(detectorName));
}

float IIBDescriptorExtractor::scaleFactorFor(const Ptr<Feature2D>& detector)
{
    if (!detector)
        CV_Error(Error::StsNullPtr, "the detector is null");
    if (const Ptr<NormalizedDetector> wrapper = detector.dynamicCast<NormalizedDetector>())
        return scaleFactorFor(wrapper->getDetector());
    return scaleFactorFor(detector->getDefaultName());
}

Ptr<IIBDescriptorExtractor> IIBDescriptorExtractor::createRecommended(int maxFeatures)
{
    return createFor(HessianDetector::create(maxFeatures), PRESET_UNIVERSAL);
}

Ptr<IIBDescriptorExtractor> IIBDescriptorExtractor::createFor(const Ptr<Feature2D>& detector, int preset)
{
    const float scaleFactor = scaleFactorFor(detector);
    const Ptr<IIBDescriptorExtractor> extractor =
            preset == -1 ? create(scaleFactor) : createPreset(preset, scaleFactor);
    extractor->setDetector(detector);
    return extractor;
}

}}  // namespace cv::iib
