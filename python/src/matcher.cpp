// SPDX-License-Identifier: Apache-2.0

#include "arrays.hpp"
#include "bindings.hpp"

#include "opencv2/iib.hpp"

namespace iib_python {

namespace {

typedef cv::iib::HierarchicalMatcher Matcher;
typedef std::vector<cv::Mat> Mats;

cv::Ptr<Matcher> clone(const Matcher& self, bool emptyTrainData)
{
    return self.clone(emptyTrainData).dynamicCast<Matcher>();
}

//! For a train set of a call: counts its cost with that of `self`.
cv::Ptr<Matcher> on(const Matcher& self, const cv::Mat& train)
{
    const cv::Ptr<Matcher> given = clone(self, true);
    given->add(Mats{train});
    return given;
}

Mats trainDescriptors(const Matcher& self)
{
    Mats copies;
    for (const cv::Mat& d : self.getTrainDescriptors())
        copies.push_back(d.clone());
    return copies;
}

//! Indices, distances, images.
std::tuple<cv::Mat, cv::Mat, cv::Mat> knnMatchArrays(
        Matcher& self, const cv::Mat& queries, int k, const Mats& masks)
{
    cv::Mat indices, distances, images;
    self.knnMatchArrays(queries, indices, distances, k, masks, images);
    for (cv::Mat* matrix : {&indices, &distances, &images})
        if (matrix->empty())
            matrix->create(0, k, CV_32S);
    return {indices, distances, images};
}

std::vector<cv::DMatch> radiusMatch(
        Matcher& self, const cv::Mat& queries, float maxDistance, const Mats& masks)
{
    std::vector<std::vector<cv::DMatch>> matches;
    self.radiusMatch(queries, matches, maxDistance, masks);
    std::vector<cv::DMatch> all;
    for (const std::vector<cv::DMatch>& row : matches)
        all.insert(all.end(), row.begin(), row.end());
    return all;
}

}  // namespace

void bindMatcher(nb::module_& m)
{
    nb::class_<Matcher>(m, "Matcher")
            .def_static(
                    "create", nb::overload_cast<const std::vector<int>&, int, float, bool>(&Matcher::create))
            .def_static("create", nb::overload_cast<>(&Matcher::create))
            .def_static("createRecommended", &Matcher::createRecommended)
            .def_static(
                    "loadIndex",
                    [](nb::object file) {
                        const std::string name = pathOf(file);
                        nb::gil_scoped_release release;
                        return Matcher::loadIndex(name);
                    },
                    nb::arg().none())
            .def(
                    "saveIndex",
                    [](const Matcher& self, nb::object file) {
                        const std::string name = pathOf(file);
                        nb::gil_scoped_release release;
                        self.saveIndex(name);
                    },
                    nb::arg().none())
            .def("clone", &clone)
            .def("on", &on, WithoutGil())
            .def(
                    "add", [](Matcher& self, const Mats& descriptors) { self.add(descriptors); },
                    WithoutGil())
            .def("clear", &Matcher::clear)
            .def("empty", &Matcher::empty)
            .def("getTrainDescriptors", &trainDescriptors)
            .def("radiusMatch", &radiusMatch, WithoutGil())
            .def("knnMatchArrays", &knnMatchArrays, WithoutGil())
            .def("rows",
                    [](const Matcher& self) {
                        int64_t rows = 0;
                        for (const cv::Mat& descriptors : self.getTrainDescriptors())
                            rows += descriptors.rows;
                        return rows;
                    })
            .def("levelSizes", &Matcher::levelSizes)
            .def_prop_rw("mode", &Matcher::getMode, &Matcher::setMode)
            .def("setThresholds", &Matcher::setThresholds)
            .def("getThresholds", &Matcher::getThresholds)
            .def_prop_rw("crossCheck", &Matcher::getCrossCheck, &Matcher::setCrossCheck)
            .def_prop_rw("maxRatio", &Matcher::getMaxRatio, &Matcher::setMaxRatio)
            .def("matchCost", &Matcher::matchCost)
            .def("resetCost", &Matcher::resetCost)
            .def("parameters", [](const Matcher& self) { return parametersOf(self); })
            .def("setParameters", [](Matcher& self, const std::string& text) { setParameters(self, text); });
}

}  // namespace iib_python
