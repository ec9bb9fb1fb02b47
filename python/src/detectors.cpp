// SPDX-License-Identifier: Apache-2.0

#include "arrays.hpp"
#include "bindings.hpp"

#include "opencv2/iib.hpp"

namespace iib_python {

namespace {

typedef cv::iib::NormalizedDetector Normalized;
typedef cv::iib::HessianDetector Hessian;

/** @brief A detector of Python, for instance of a foreign cv2, as this OpenCV's Feature2D.

`function(image, mask or None)` gives rows of keypoints (arrays.hpp). Only arrays cross; the image that it gets is
a copy, since a detector may keep it. Any thread may call it. It computes no descriptors.
 */
class ForeignDetector CV_FINAL : public cv::Feature2D
{
public:
    ForeignDetector(nb::callable function_, const std::string& name_) : function(function_), name(name_) {}
    ~ForeignDetector()
    {
        nb::gil_scoped_acquire gil;
        function.reset();
    }

    void detect(cv::InputArray image, std::vector<cv::KeyPoint>& keypoints, cv::InputArray mask) CV_OVERRIDE
    {
        nb::gil_scoped_acquire gil;
        const cv::Mat allowed = mask.getMat();
        const nb::object rows = function(
                toNumpy(image.getMat().clone()), allowed.empty() ? nb::none() : toNumpy(allowed.clone()));
        keypoints = nb::cast<std::vector<cv::KeyPoint>>(rows);
    }
    bool empty() const CV_OVERRIDE { return false; }
    cv::String getDefaultName() const CV_OVERRIDE { return "Feature2D." + name; }

private:
    nb::object function;
    std::string name;
};

//! @param mask empty: everywhere.
std::vector<cv::KeyPoint> detect(cv::Feature2D& self, const cv::Mat& image, const cv::Mat& mask)
{
    std::vector<cv::KeyPoint> keypoints;
    if (!image.empty())
        self.detect(image, keypoints, mask);
    return keypoints;
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
            .def("detect", &detect, WithoutGil())
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
                    "normalizationSigma", &Hessian::getNormalizationSigma, &Hessian::setNormalizationSigma)
            .def_prop_rw("workingSize", &Hessian::getWorkingSize, &Hessian::setWorkingSize);
}

}  // namespace iib_python
