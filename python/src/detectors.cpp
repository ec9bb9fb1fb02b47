// SPDX-License-Identifier: Apache-2.0

#include "bindings.hpp"
#include "foreign_detector.hpp"

namespace iib_python {

namespace {

typedef cv::iib::NormalizedDetector Normalized;
typedef cv::iib::HessianDetector Hessian;

nb::object detect(cv::Feature2D& self, const Array& image, const Array& mask)
{
    const cv::Mat view = viewOf(image, "the image");
    const cv::Mat allowed = viewOf(mask, "the mask");  // empty: everywhere
    std::vector<cv::KeyPoint> keypoints;
    {
        nb::gil_scoped_release release;
        if (!view.empty())
            self.detect(view, keypoints, allowed);
    }
    return toNumpy(toRows(keypoints));
}

std::shared_ptr<cv::Feature2D> foreignDetector(nb::callable function, const std::string& name)
{
    return std::make_shared<ForeignDetector>(function, name);
}

}  // namespace

void bindDetectors(nb::module_& m)
{
    nb::class_<cv::Feature2D>(m, "Detector")
            .def_static("foreign", &foreignDetector)
            .def("detect", &detect)
            .def("descriptorSize", &cv::Feature2D::descriptorSize)
            .def("descriptorType", &cv::Feature2D::descriptorType)
            .def("defaultNorm", &cv::Feature2D::defaultNorm)
            .def("empty", &cv::Feature2D::empty)
            .def("getDefaultName",
                    [](const cv::Feature2D& self) { return std::string(self.getDefaultName()); });
    nb::class_<Normalized, cv::Feature2D>(m, "NormalizedDetector")
            .def_static("create", &Normalized::create)
            .def_prop_rw("sigma", &Normalized::getSigma, &Normalized::setSigma);
    nb::class_<Hessian, cv::Feature2D>(m, "HessianDetector")
            .def_static("create", &Hessian::create)
            .def_prop_rw("maxFeatures", &Hessian::getMaxFeatures, &Hessian::setMaxFeatures)
            .def_prop_rw("threshold", &Hessian::getThreshold, &Hessian::setThreshold)
            .def_prop_rw("scales", &Hessian::getScales, &Hessian::setScales)
            .def_prop_rw("sigma", &Hessian::getSigma, &Hessian::setSigma)
            .def_prop_rw(
                    "normalizationSigma", &Hessian::getNormalizationSigma, &Hessian::setNormalizationSigma);
}

}  // namespace iib_python
