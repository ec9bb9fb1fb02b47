// SPDX-License-Identifier: Apache-2.0

#include "arrays.hpp"
#include "bindings.hpp"

#include "opencv2/iib_geometry.hpp"

namespace iib_python {

namespace {

nb::object arrayOrNone(bool found, const cv::Mat& matrix) { return found ? toNumpy(matrix) : nb::none(); }

// Whether there is a pose, R, t, marks of the inliers, covariance.
nb::tuple findRelativePose(const Array& points1, const Array& points2, const Array& cameraMatrix1,
        const Array& cameraMatrix2, double scale)
{
    const cv::Mat first = viewOf(points1, "points1"), second = viewOf(points2, "points2"),
                  camera1 = viewOf(cameraMatrix1, "cameraMatrix1"),
                  camera2 = viewOf(cameraMatrix2, "cameraMatrix2");
    cv::Mat R, t, inliers, covariance;
    bool found;
    {
        nb::gil_scoped_release release;
        found = cv::iib::findRelativePose(first, second, camera1, camera2, R, t, inliers, scale, covariance);
    }
    return nb::make_tuple(found, arrayOrNone(found, R), arrayOrNone(found, t), toNumpy(inliers),
            arrayOrNone(found, covariance));
}

// Whether they show the same, transform, deviations of the corners, matches that agree.
nb::tuple alignImages(const Array& reference, const Array& image, int model)
{
    const cv::Mat first = viewOf(reference, "the reference"), second = viewOf(image, "the image");
    cv::Mat transform, error, matches;
    bool found;
    {
        nb::gil_scoped_release release;
        found = cv::iib::alignImages(first, second, transform, model, error, matches);
    }
    return nb::make_tuple(found, arrayOrNone(found, transform), arrayOrNone(found, error), toNumpy(matches));
}

}  // namespace

void bindGeometry(nb::module_& m)
{
    m.def("findRelativePose", &findRelativePose);
    m.def("alignImages", &alignImages);
}

}  // namespace iib_python
