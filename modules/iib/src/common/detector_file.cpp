// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "detector_file.hpp"

#include <functional>
#include <type_traits>

#include "file_numbers.hpp"

namespace cv {
namespace iib {

namespace {

//! A parameter of a detector: a number behind a getter and a setter.
struct Property
{
    template <class D, class Base, class T>
    Property(const char* name_, D& d, T (Base::*getter)() const, void (Base::*setter)(T))
        : name(name_), get([&d, getter] { return (double)(d.*getter)(); }),
          read([&d, name_, setter](const FileNode& parameters) {
              typename std::conditional<std::is_enum<T>::value, int, T>::type value = 0;
              readNumber(parameters, name_, value);
              (d.*setter)((T)value);
          })
    {
    }

    const char* name;
    std::function<double()> get;
    std::function<void(const FileNode&)> read;  //!< of the number of this name, which must be there
};

typedef std::vector<Property> Properties;

Properties propertiesOf(ORB& d)
{
    return {{"maxFeatures", d, &ORB::getMaxFeatures, &ORB::setMaxFeatures},
            {"scaleFactor", d, &ORB::getScaleFactor, &ORB::setScaleFactor},
            {"nLevels", d, &ORB::getNLevels, &ORB::setNLevels},
            {"edgeThreshold", d, &ORB::getEdgeThreshold, &ORB::setEdgeThreshold},
            {"firstLevel", d, &ORB::getFirstLevel, &ORB::setFirstLevel},
            {"WTA_K", d, &ORB::getWTA_K, &ORB::setWTA_K},
            {"scoreType", d, &ORB::getScoreType, &ORB::setScoreType},
            {"patchSize", d, &ORB::getPatchSize, &ORB::setPatchSize},
            {"fastThreshold", d, &ORB::getFastThreshold, &ORB::setFastThreshold}};
}

Properties propertiesOf(MSER& d)
{
    return {{"delta", d, &MSER::getDelta, &MSER::setDelta},
            {"minArea", d, &MSER::getMinArea, &MSER::setMinArea},
            {"maxArea", d, &MSER::getMaxArea, &MSER::setMaxArea},
            {"pass2Only", d, &MSER::getPass2Only, &MSER::setPass2Only}};
}

Properties propertiesOf(GFTTDetector& d)
{
    typedef GFTTDetector D;
    return {{"maxFeatures", d, &D::getMaxFeatures, &D::setMaxFeatures},
            {"qualityLevel", d, &D::getQualityLevel, &D::setQualityLevel},
            {"minDistance", d, &D::getMinDistance, &D::setMinDistance},
            {"blockSize", d, &D::getBlockSize, &D::setBlockSize},
            {"harrisDetector", d, &D::getHarrisDetector, &D::setHarrisDetector},
            {"k", d, &D::getK, &D::setK}};
}

//! FAST and AGAST.
template <class D> Properties propertiesOf(D& d)
{
    return {{"threshold", d, &D::getThreshold, &D::setThreshold},
            {"nonmaxSuppression", d, &D::getNonmaxSuppression, &D::setNonmaxSuppression},
            {"type", d, &D::getType, &D::setType}};
}

#if CV_VERSION_MAJOR < 5
Properties propertiesOf(BRISK& d)
{
    return {{"threshold", d, &BRISK::getThreshold, &BRISK::setThreshold},
            {"octaves", d, &BRISK::getOctaves, &BRISK::setOctaves}};
}
#endif

template <class D> Ptr<Feature2D> make() { return D::create(); }

//! None of another class that has the same name.
template <class D> Properties properties(Feature2D& detector)
{
    D* const d = dynamic_cast<D*>(&detector);
    return d ? propertiesOf(*d) : Properties();
}

//! Of detectors that write and read their parameters themselves, or tell none.
Properties noProperties(Feature2D&) { return Properties(); }

struct DetectorClass
{
    const char* name;  //!< Algorithm::getDefaultName
    Ptr<Feature2D> (*create)();
    Properties (*properties)(Feature2D&);
};

const DetectorClass classes[] = {{"Feature2D.ORB", make<ORB>, properties<ORB>},
        {"Feature2D.SIFT", make<SIFT>, noProperties}, {"Feature2D.MSER", make<MSER>, properties<MSER>},
        {"Feature2D.FastFeatureDetector", make<FastFeatureDetector>, properties<FastFeatureDetector>},
        {"Feature2D.GFTTDetector", make<GFTTDetector>, properties<GFTTDetector>},
#if CV_VERSION_MAJOR < 5  // opencv_contrib's since then
        {"Feature2D.AKAZE", make<AKAZE>, noProperties}, {"Feature2D.KAZE", make<KAZE>, noProperties},
        {"Feature2D.BRISK", make<BRISK>, properties<BRISK>},
        {"Feature2D.AgastFeatureDetector", make<AgastFeatureDetector>, properties<AgastFeatureDetector>},
#endif
        {"Feature2D.SimpleBlobDetector", make<SimpleBlobDetector>, noProperties}};

const DetectorClass* classOf(const String& name)
{
    for (const DetectorClass& c : classes)
        if (name == c.name)
            return &c;
    return 0;
}

}  // namespace

void writeDetector(FileStorage& fs, const Feature2D& detector)
{
    const String name = detector.getDefaultName();
    fs << "class" << name;
    if (const NormalizedDetector* const wrapper = dynamic_cast<const NormalizedDetector*>(&detector))
    {
        fs << "sigma" << wrapper->getSigma() << "detector"
           << "{";
        writeDetector(fs, *wrapper->getDetector());
        fs << "}";
        return;
    }
    fs << "parameters"
       << "{";
    const DetectorClass* const known = classOf(name);
    const Properties own = known ? known->properties(const_cast<Feature2D&>(detector)) : Properties();
    for (const Property& property : own)  // only their getters are called
        fs << property.name << property.get();
    if (own.empty())
        detector.write(fs);
    fs << "}";
}

Ptr<Feature2D> readDetector(const FileNode& node, const Ptr<Feature2D>& present)
{
    const String name = node.isMap() && node["class"].isString() ? (String)node["class"] : String();
    if (name.empty())
        CV_Error(Error::StsParseError, "the file's detector has no class; it must be what write() wrote");
    const FileNode parameters = node["parameters"];
    const DetectorClass* const known = classOf(name);
    if (known)
    {
        const Ptr<Feature2D> detector = known->create();
        const Properties own = known->properties(*detector);
        for (const Property& property : own)
        {
            if (parameters[property.name].empty())
                CV_Error(Error::StsParseError,
                        "the file's detector, " + name + ", has no number " + property.name);
            property.read(parameters);
        }
        if (own.empty() && !parameters.empty())
            detector->read(parameters);
        return detector;
    }
    if (name == "Feature2D.NormalizedDetector")
    {
        const Ptr<NormalizedDetector> wrapper = present.dynamicCast<NormalizedDetector>();
        const Ptr<Feature2D> inside =
                readDetector(node["detector"], wrapper ? wrapper->getDetector() : present);
        float sigma = 0;  // refused by create()
        readNumber(node, "sigma", sigma);
        return NormalizedDetector::create(inside, sigma);
    }
    if (name != present->getDefaultName())
        CV_Error(Error::StsParseError, "the file's detector is a " + name +
                                               ", which only its own library creates; create an extractor, "
                                               "give one to setDetector(), then read()");
    present->read(parameters);
    return present;
}

}  // namespace iib
}  // namespace cv
