// SPDX-License-Identifier: Apache-2.0

#include "bindings.hpp"
#include "held.hpp"

#include "opencv2/iib.hpp"

namespace iib_python {

namespace {

typedef cv::iib::HierarchicalMatcher Matcher;
typedef Held<Matcher> Self;
typedef std::vector<cv::Mat> Mats;

Self clone(const Self& self, bool emptyTrainData)
{
    return {self->clone(emptyTrainData).dynamicCast<Matcher>()};
}

//! A matcher for the train set of a call, whose cost is added to that of `self`.
Self on(const Self& self, const cv::Mat& train)
{
    const Self given = clone(self, true);
    given->add(Mats{train});
    return given;
}

nb::tuple trainDescriptors(const Self& self)
{
    Mats copies;
    for (const cv::Mat& d : self->getTrainDescriptors())
        copies.push_back(d.clone());
    return nb::tuple(nb::cast(copies));
}

//! Indices, distances, images.
std::tuple<cv::Mat, cv::Mat, cv::Mat> knnMatchArrays(
        const Self& self, const cv::Mat& queries, int k, const Mats& masks)
{
    cv::Mat indices, distances, images;
    self->knnMatchArrays(queries, indices, distances, k, masks, images);
    for (cv::Mat* matrix : {&indices, &distances, &images})
        if (matrix->empty())
            matrix->create(0, k, CV_32S);
    return {indices, distances, images};
}

std::vector<cv::DMatch> radiusMatch(
        const Self& self, const cv::Mat& queries, float maxDistance, const Mats& masks)
{
    std::vector<std::vector<cv::DMatch>> matches;
    self->radiusMatch(queries, matches, maxDistance, masks);
    std::vector<cv::DMatch> all;
    for (const std::vector<cv::DMatch>& row : matches)
        all.insert(all.end(), row.begin(), row.end());
    return all;
}

const char* const MAX_RATIO =
        R"(Ratio test of match, knnMatch and knnMatchArrays: a query keeps its matches only if its least distance is less
than maxRatio times its second least.

:param maxRatio: in (0, 1]; 1 turns the test off. An exact tie does not pass: 9 and 10 bits do not at .9.)";

}  // namespace

void bindMatcher(nb::module_& m)
{
    nb::class_<Self> cls(m, "HierarchicalMatcher");
    sharing(cls);
    cls.def("__init__", [](Self* self) { new (self) Self{Matcher::create()}; })
            .def("__init__",
                    [](Self* self, const std::vector<int>& levelSizes, int mode, float threshold,
                            bool crossCheck) {
                        new (self) Self{Matcher::create(levelSizes, mode, threshold, crossCheck)};
                    })
            .def_static("_createRecommended", [] { return Self{Matcher::createRecommended()}; })
            .def_static(
                    "_loadIndex",
                    [](nb::object file) {
                        const std::string name = pathOf(file);
                        nb::gil_scoped_release release;
                        return Self{Matcher::loadIndex(name)};
                    },
                    nb::arg().none())
            .def(
                    "saveIndex",
                    [](const Self& self, nb::object file) {
                        const std::string name = pathOf(file);
                        nb::gil_scoped_release release;
                        self->saveIndex(name);
                    },
                    nb::arg().none(),
                    nb::sig("def saveIndex(self, filename: opencv_iib._arguments.Path) -> None"),
                    "Writes level sizes, parameters and all train descriptors to a binary file, the same as "
                    "C++ writes.")
            .def("_clone", &clone)
            .def("_on", &on, WithoutGil())
            .def(
                    "_add", [](Self& self, const Mats& descriptors) { self->add(descriptors); }, WithoutGil())
            .def("_radiusMatch", &radiusMatch, WithoutGil())
            .def("_knnMatchArrays", &knnMatchArrays, WithoutGil())
            .def(
                    "setThresholds",
                    [](Self& self, const std::vector<float>& thresholds) { self->setThresholds(thresholds); },
                    nb::sig("def setThresholds(self, thresholds: typing.Sequence[float]) -> None"),
                    "Thresholds of THRESHOLD, 0 to 1: one for every level but the last, or a single one for "
                    "all.")
            .def("_parametersAsText", [](const Self& self) { return parametersOf(*self); })
            .def("_setParameters", [](Self& self, const std::string& text) { setParameters(*self, text); })
            .def(
                    "train", [](Self&) {}, "Nothing: the index is ready after add().")
            .def("getTrainDescriptors", &trainDescriptors,
                    nb::sig("def getTrainDescriptors(self) -> tuple[numpy.typing.NDArray[numpy.uint8], ...]"),
                    "Copies of the descriptors added, an array an image.");
    method(cls, "resetCost", &Matcher::resetCost, "Begins a new count for matchCost().");
    method(cls, "clear", &Matcher::clear, "Forgets all train descriptors.");
    method(cls, "getThresholds", &Matcher::getThresholds, "Thresholds of THRESHOLD, one a level.");
    method(cls, "levelSizes", &Matcher::levelSizes,
            "Bytes of each level, coarse first; empty while a matcher created without them has seen no "
            "descriptors.");
    method(cls, "empty", &Matcher::empty, "True without train descriptors.");
    method(cls, "isMaskSupported", &Matcher::isMaskSupported, "True.");
    method(cls, "matchCost", &Matcher::matchCost,
            "The paper's MC: bits compared / bits brute force would compare, since resetCost(); 0 before any "
            "call.");
    property(cls, "Mode", &Matcher::getMode, &Matcher::setMode, "EXACT, THRESHOLD or ADAPTIVE.", "Mode");
    property(cls, "CrossCheck", &Matcher::getCrossCheck, &Matcher::setCrossCheck,
            "Whether to report only pairs that are among each other's nearest.");
    property(cls, "MaxRatio", &Matcher::getMaxRatio, &Matcher::setMaxRatio, MAX_RATIO);
}

}  // namespace iib_python
