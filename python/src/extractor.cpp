// SPDX-License-Identifier: Apache-2.0

#include "bindings.hpp"
#include "held.hpp"

#include "opencv2/iib.hpp"

namespace iib_python {

namespace {

typedef cv::iib::IIBDescriptorExtractor Extractor;
typedef HeldDetector<Extractor> Self;

// The descriptors, and the numbers of the keypoints that were kept if not all were.
std::tuple<cv::Mat, std::optional<cv::Mat>> compute(const Self& self, const cv::Mat& image,
        std::vector<cv::KeyPoint> keypoints, const std::vector<cv::Mat>& extraChannels)
{
    const size_t given = keypoints.size();
    for (size_t i = 0; i < given; i++)
        keypoints[i].class_id = (int)i;
    cv::Mat descriptors;
    self->compute(image, extraChannels, keypoints, descriptors);
    if (descriptors.empty())
        descriptors.create(0, self->descriptorSize(), CV_8U);
    if (keypoints.size() == given)
        return {descriptors, std::nullopt};
    cv::Mat kept((int)keypoints.size(), 1, CV_32S);
    for (size_t i = 0; i < keypoints.size(); i++)
        kept.at<int>((int)i) = keypoints[i].class_id;
    return {descriptors, kept};
}

// A copy without its detector, which may be an object of Python that no file can hold.
cv::Ptr<Extractor> withoutDetector(const Extractor& self)
{
    const cv::Ptr<Extractor> result = Extractor::create(self.getScaleFactor(), self.getGranularity(),
            self.getChannels(), self.getMapping(), self.getOverlap(), false, self.getExtraChannels());
    result->setOrientation(self.getOrientation());
    result->setBorder(self.getBorder());
    result->setSelection(self.getSelection());
    return result;
}

void write(const Self& self, nb::object file) { withoutDetector(*self)->save(pathOf(file)); }

const char* const WRITE =
        R"(Writes the parameters, but not the detector, to a .yml, .xml or .json file, which read() and C++ read.

:raises opencv_iib.error: if the file cannot be written; an older one is kept. Also for a link that leads to no file, a folder, a
    device or a pipe.)";

void create(Self* self, float scaleFactor, int granularity, int channels, int mapping, bool overlap,
        bool useOrientation, int extraChannels)
{
    new (self) Self(Extractor::create(
            scaleFactor, granularity, channels, mapping, overlap, useOrientation, extraChannels));
}

cv::Mat getSelection(const Self& self)
{
    const cv::Mat quads = self->getSelection();
    return quads.empty() ? cv::Mat(0, 5, CV_32S) : quads;
}

}  // namespace

void bindExtractor(nb::module_& m)
{
    nb::class_<Self, Detector> cls(m, "IIBDescriptorExtractor");
    sharing(cls);
    cls.def("__init__", &create)
            .def_static("_createPreset",
                    [](int preset, float scaleFactor) {
                        return Self(Extractor::createPreset(preset, scaleFactor));
                    })
            .def_static("_createFor",
                    [](const Detector& detector, int preset) {
                        return Self(Extractor::createFor(detector.held, preset));
                    })
            .def_static("_scaleFactorFor", nb::overload_cast<const cv::String&>(&Extractor::scaleFactorFor))
            .def_static("_scaleFactorFor",
                    [](const Detector& detector) { return Extractor::scaleFactorFor(detector.held); })
            .def("_compute", &compute, WithoutGil())
            .def("_setDetector",
                    [](Self& self, const Detector& detector) { self->setDetector(detector.held); })
            .def("_setSelection", [](Self& self, const cv::Mat& quads) { self->setSelection(quads); })
            .def("getSelection", &getSelection,
                    nb::sig("def getSelection(self) -> numpy.typing.NDArray[numpy.int32]"),
                    "Q x 5 int32, as setSelection takes it; 0 x 5 if there is no selection.")
            .def("write", &write, nb::arg().none(),
                    nb::sig("def write(self, fileName: opencv_iib._arguments.Path) -> None"), WRITE)
            .def("save", &write, nb::arg().none(),
                    nb::sig("def save(self, filename: opencv_iib._arguments.Path) -> None"),
                    "The same as write().")
            .def("_parameters", [](const Self& self) { return parametersOf(*withoutDetector(*self)); })
            .def("_setParameters", [](Self& self, const std::string& text) { setParameters(*self, text); });
    method(cls, "levelSizes", &Extractor::levelSizes,
            "Bytes of each level, coarse first; their sum is descriptorSize().");
    method(cls, "descriptorType", &Extractor::descriptorType, "CV_8U, which is 0.");
    method(cls, "defaultNorm", &Extractor::defaultNorm, "NORM_HAMMING, which is 6.");
    property(cls, "ScaleFactor", &Extractor::getScaleFactor, &Extractor::setScaleFactor,
            "Side of the described square in units of a keypoint's size, > 0.");
    property(cls, "Granularity", &Extractor::getGranularity, &Extractor::setGranularity,
            "Number of levels, 1 to 6. Another one ends a selection, as other channels, mapping or overlap "
            "do.");
    property(cls, "Channels", &Extractor::getChannels, &Extractor::setChannels,
            "A sum of CHANNEL_ values; may be 0 if there are extra channels.", "Channel");
    property(cls, "Mapping", &Extractor::getMapping, &Extractor::setMapping, "One of MAPPING_.", "Mapping");
    property(cls, "Overlap", &Extractor::getOverlap, &Extractor::setOverlap,
            "Whether the windows of 2 x 2 cells slide by one cell instead of two.");
    property(cls, "UseOrientation", &Extractor::getUseOrientation, &Extractor::setUseOrientation,
            "True: ORIENTATION_KEYPOINT, False: ORIENTATION_NONE. The getter returns False for "
            "ORIENTATION_NONE alone.");
    property(cls, "Orientation", &Extractor::getOrientation, &Extractor::setOrientation,
            "How the described squares are rotated: one of ORIENTATION_.", "Orientation", "mode");
    property(cls, "ExtraChannels", &Extractor::getExtraChannels, &Extractor::setExtraChannels,
            "Number of maps that computeWithChannels is given, 0 to 16.");
    property(cls, "Border", &Extractor::getBorder, &Extractor::setBorder, "One of BORDER_.", "Border");
}

}  // namespace iib_python
