// SPDX-License-Identifier: Apache-2.0

#include "arrays.hpp"
#include "bindings.hpp"

#include "opencv2/iib.hpp"

namespace iib_python {

namespace {

typedef cv::iib::IIBDescriptorExtractor Extractor;

// The descriptors, and which keypoints were kept if not all were.
std::tuple<cv::Mat, std::optional<cv::Mat>> compute(Extractor& self, const cv::Mat& image,
        std::vector<cv::KeyPoint> keypoints, const std::vector<cv::Mat>& extraChannels)
{
    const size_t given = keypoints.size();
    for (size_t i = 0; i < given; i++)
        keypoints[i].class_id = (int)i;
    cv::Mat descriptors;
    self.compute(image, extraChannels, keypoints, descriptors);
    if (descriptors.empty())
        descriptors.create(0, self.descriptorSize(), CV_8U);
    if (keypoints.size() == given)
        return {descriptors, std::nullopt};
    cv::Mat kept((int)keypoints.size(), 1, CV_32S);
    for (size_t i = 0; i < keypoints.size(); i++)
        kept.at<int>((int)i) = keypoints[i].class_id;
    return {descriptors, kept};
}

// The same without its detector, which may be an object of Python that no file can hold.
cv::Ptr<Extractor> withoutDetector(const Extractor& self)
{
    const cv::Ptr<Extractor> result = Extractor::create(self.getScaleFactor(), self.getGranularity(),
            self.getChannels(), self.getMapping(), self.getOverlap(), false, self.getExtraChannels());
    result->setOrientation(self.getOrientation());
    result->setBorder(self.getBorder());
    result->setSelection(self.getSelection());
    return result;
}

}  // namespace

void bindExtractor(nb::module_& m)
{
    nb::class_<Extractor, cv::Feature2D>(m, "Extractor")
            .def_static("create", &Extractor::create)
            .def_static("createPreset", &Extractor::createPreset)
            .def_static("createFor", &Extractor::createFor)
            .def_static("scaleFactorFor", nb::overload_cast<const cv::String&>(&Extractor::scaleFactorFor))
            .def_static("scaleFactorFor",
                    nb::overload_cast<const cv::Ptr<cv::Feature2D>&>(&Extractor::scaleFactorFor))
            .def("compute", &compute, WithoutGil())
            .def("setDetector", &Extractor::setDetector)
            .def("levelSizes", &Extractor::levelSizes)
            .def_prop_rw("scaleFactor", &Extractor::getScaleFactor, &Extractor::setScaleFactor)
            .def_prop_rw("granularity", &Extractor::getGranularity, &Extractor::setGranularity)
            .def_prop_rw("channels", &Extractor::getChannels, &Extractor::setChannels)
            .def_prop_rw("mapping", &Extractor::getMapping, &Extractor::setMapping)
            .def_prop_rw("overlap", &Extractor::getOverlap, &Extractor::setOverlap)
            .def_prop_rw("useOrientation", &Extractor::getUseOrientation, &Extractor::setUseOrientation)
            .def_prop_rw("orientation", &Extractor::getOrientation, &Extractor::setOrientation)
            .def_prop_rw("extraChannels", &Extractor::getExtraChannels, &Extractor::setExtraChannels)
            .def_prop_rw("border", &Extractor::getBorder, &Extractor::setBorder)
            .def("setSelection", [](Extractor& self, const cv::Mat& quads) { self.setSelection(quads); })
            .def("getSelection",
                    [](const Extractor& self) {
                        const cv::Mat quads = self.getSelection();
                        return quads.empty() ? cv::Mat(0, 5, CV_32S) : quads;
                    })
            .def(
                    "save",
                    [](const Extractor& self, nb::object file) { withoutDetector(self)->save(pathOf(file)); },
                    nb::arg().none())
            .def("parameters", [](const Extractor& self) { return parametersOf(*withoutDetector(self)); })
            .def("setParameters",
                    [](Extractor& self, const std::string& text) { setParameters(self, text); });
}

}  // namespace iib_python
