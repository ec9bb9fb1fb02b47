// SPDX-License-Identifier: Apache-2.0

#include "bindings.hpp"
#include "foreign_detector.hpp"

#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/string.h>

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

std::shared_ptr<Normalized> createNormalized(std::shared_ptr<cv::Feature2D> detector, float sigma)
{
    return Normalized::create(detector, sigma);
}

std::shared_ptr<Hessian> createHessian(
        int maxFeatures, float threshold, int scales, float sigma, float normalizationSigma)
{
    return Hessian::create(maxFeatures, threshold, scales, sigma, normalizationSigma);
}

// Matches are rows of two columns: index into the first keypoints, index into the second.
double estimateRotation(const Array& keypoints1, const Array& keypoints2, const Array& matches1to2)
{
    const cv::Mat pairs = viewOf(matches1to2, "matches");
    if (!pairs.empty() && (pairs.type() != CV_32S || pairs.cols != 2))
        CV_Error(cv::Error::StsBadArg,
                "matches are objects like cv2.DMatch or an array of 2 columns of integers "
                "(queryIdx, trainIdx)");
    std::vector<cv::DMatch> matches;
    for (int i = 0; i < pairs.rows; i++)
        matches.push_back(cv::DMatch(pairs.at<int>(i, 0), pairs.at<int>(i, 1), 0));
    const std::vector<cv::KeyPoint> first = toKeyPoints(viewOf(keypoints1, "keypoints"));
    const std::vector<cv::KeyPoint> second = toKeyPoints(viewOf(keypoints2, "keypoints"));
    nb::gil_scoped_release release;
    return cv::iib::estimateRotation(first, second, matches);
}

}  // namespace

void bindDetectors(nb::module_& m)
{
    nb::class_<cv::Feature2D>(m, "Detector").def_static("foreign", &foreignDetector).def("detect", &detect);
    nb::class_<Normalized, cv::Feature2D>(m, "NormalizedDetector")
            .def_static("create", &createNormalized)
            .def("setSigma", &Normalized::setSigma)
            .def("getSigma", &Normalized::getSigma);
    nb::class_<Hessian, cv::Feature2D>(m, "HessianDetector")
            .def_static("create", &createHessian)
            .def("setMaxFeatures", &Hessian::setMaxFeatures)
            .def("getMaxFeatures", &Hessian::getMaxFeatures)
            .def("setThreshold", &Hessian::setThreshold)
            .def("getThreshold", &Hessian::getThreshold)
            .def("setScales", &Hessian::setScales)
            .def("getScales", &Hessian::getScales)
            .def("setSigma", &Hessian::setSigma)
            .def("getSigma", &Hessian::getSigma)
            .def("setNormalizationSigma", &Hessian::setNormalizationSigma)
            .def("getNormalizationSigma", &Hessian::getNormalizationSigma);
    m.def("estimateRotation", &estimateRotation);
}

}  // namespace iib_python
