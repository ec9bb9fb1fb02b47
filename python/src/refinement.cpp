// SPDX-License-Identifier: Apache-2.0

#include "bindings.hpp"
#include "keypoints.hpp"

#include "opencv2/iib.hpp"

namespace iib_python {

namespace {

nb::tuple refineMatches(const Array& image1, const Array& keypoints1, const Array& image2,
        const Array& keypoints2, const Array& matches1to2)
{
    const cv::Mat view1 = viewOf(image1, "the image"), view2 = viewOf(image2, "the image");
    const std::vector<cv::KeyPoint> first = toKeyPoints(viewOf(keypoints1, "keypoints"));
    const std::vector<cv::KeyPoint> second = toKeyPoints(viewOf(keypoints2, "keypoints"));
    const std::vector<cv::DMatch> matches = toMatches(viewOf(matches1to2, "matches"));
    cv::Mat points1, points2, covariances, similarities;
    {
        nb::gil_scoped_release release;
        cv::iib::refineMatches(
                view1, first, view2, second, matches, points1, points2, covariances, similarities);
    }
    return nb::make_tuple(toNumpy(points1), toNumpy(points2), toNumpy(covariances), toNumpy(similarities));
}

}  // namespace

void bindRefinement(nb::module_& m) { m.def("refineMatches", &refineMatches); }

}  // namespace iib_python
