// SPDX-License-Identifier: Apache-2.0

#include "bindings.hpp"
#include "keypoints.hpp"

#include "opencv2/iib.hpp"

namespace iib_python {

namespace {

double estimateRotation(const Array& keypoints1, const Array& keypoints2, const Array& matches1to2)
{
    const std::vector<cv::DMatch> matches = toMatches(viewOf(matches1to2, "matches"));
    const std::vector<cv::KeyPoint> first = toKeyPoints(viewOf(keypoints1, "keypoints"));
    const std::vector<cv::KeyPoint> second = toKeyPoints(viewOf(keypoints2, "keypoints"));
    nb::gil_scoped_release release;
    return cv::iib::estimateRotation(first, second, matches);
}

// Rotation, both images' keypoints, and matches as rows of three columns: those of estimateRotation, and the distance.
nb::tuple matchRotated(const Array& image1, const Array& keypoints1, const Array& image2,
        const Array& keypoints2, const cv::Ptr<cv::iib::IIB>& extractor,
        const cv::Ptr<cv::iib::HierarchicalMatcher>& matcher, double rotation)
{
    const cv::Mat view1 = viewOf(image1, "the image"), view2 = viewOf(image2, "the image");
    std::vector<cv::KeyPoint> first = toKeyPoints(viewOf(keypoints1, "keypoints")),
                              second = toKeyPoints(viewOf(keypoints2, "keypoints"));
    std::vector<cv::DMatch> matches;
    {
        nb::gil_scoped_release release;
        rotation = cv::iib::matchRotated(view1, first, view2, second, extractor, matcher, matches, rotation);
    }
    cv::Mat rows((int)matches.size(), 3, CV_32S);
    for (size_t i = 0; i < matches.size(); i++)
    {
        const int row[] = {matches[i].queryIdx, matches[i].trainIdx, (int)matches[i].distance};
        std::copy(row, row + 3, rows.ptr<int>((int)i));
    }
    return nb::make_tuple(rotation, toNumpy(toRows(first)), toNumpy(toRows(second)), toNumpy(rows));
}

}  // namespace

void bindRotation(nb::module_& m)
{
    m.def("estimateRotation", &estimateRotation);
    m.def("matchRotated", &matchRotated);
}

}  // namespace iib_python
