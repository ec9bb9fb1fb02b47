// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "detector_file.hpp"

#include "file_numbers.hpp"

namespace cv { namespace iib {

namespace {

void writeOrb(FileStorage& fs, const ORB& orb)
{
    fs << "maxFeatures" << orb.getMaxFeatures() << "scaleFactor" << orb.getScaleFactor() << "nLevels"
       << orb.getNLevels() << "edgeThreshold" << orb.getEdgeThreshold() << "firstLevel" << orb.getFirstLevel()
       << "WTA_K" << orb.getWTA_K() << "scoreType" << (int)orb.getScoreType() << "patchSize"
       << orb.getPatchSize() << "fastThreshold" << orb.getFastThreshold();
}

Ptr<Feature2D> readOrb(const FileNode& parameters)
{
    const auto number = [&](const char* name) {
        return numberOf<int>(parameters[name], String("the ORB detector's ") + name);
    };
    const float scaleFactor = numberOf<float>(parameters["scaleFactor"], "the ORB detector's scaleFactor");
    return ORB::create(number("maxFeatures"), scaleFactor, number("nLevels"), number("edgeThreshold"),
            number("firstLevel"), number("WTA_K"), (ORB::ScoreType)number("scoreType"), number("patchSize"),
            number("fastThreshold"));
}

}  // namespace

void writeDetector(FileStorage& fs, const Feature2D& detector)
{
    fs << "class" << detector.getDefaultName();
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
    if (const ORB* const orb = dynamic_cast<const ORB*>(&detector))
        writeOrb(fs, *orb);
    else
        detector.write(fs);
    fs << "}";
}

Ptr<Feature2D> readDetector(const FileNode& node, const Ptr<Feature2D>& present)
{
    const String name = node.isMap() && node["class"].isString() ? (String)node["class"] : String();
    if (name.empty())
        CV_Error(Error::StsParseError, "the file's detector has no class: pass a node that write() made");
    const FileNode parameters = node["parameters"];
    if (name == "Feature2D.ORB")
        return readOrb(parameters);
    if (name == "Feature2D.HessianDetector")
    {
        const Ptr<HessianDetector> detector = HessianDetector::create();
        detector->read(parameters);
        return detector;
    }
    if (name == "Feature2D.NormalizedDetector")
    {
        const Ptr<NormalizedDetector> wrapper = present.dynamicCast<NormalizedDetector>();
        const Ptr<Feature2D> inside =
                readDetector(node["detector"], wrapper ? wrapper->getDetector() : present);
        float sigma = 0;  // create() refuses it
        readNumber(node, "sigma", sigma);
        return NormalizedDetector::create(inside, sigma);
    }
    if (name != present->getDefaultName())
        CV_Error(Error::StsParseError, "the file's detector is a " + name +
                                               ", which files do not create; create an extractor, give it "
                                               "such a detector by setDetector(), then read()");
    present->read(parameters);
    return present;
}

}}  // namespace cv::iib
