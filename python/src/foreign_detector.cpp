// SPDX-License-Identifier: Apache-2.0

#include "foreign_detector.hpp"

namespace iib_python {

namespace {

//! A copy as numpy has images: rows x columns, and channels if there are several.
nb::object imageToNumpy(const cv::Mat& image)
{
    nb::object array = toNumpy(image.clone().reshape(1));
    return image.channels() == 1 ? array : array.attr("reshape")(image.rows, image.cols, image.channels());
}

}  // namespace

void ForeignDetector::detect(cv::InputArray image, std::vector<cv::KeyPoint>& keypoints, cv::InputArray mask)
{
    nb::gil_scoped_acquire gil;
    const cv::Mat allowed = mask.getMat();
    const nb::object rows =
            function(imageToNumpy(image.getMat()), allowed.empty() ? nb::none() : imageToNumpy(allowed));
    keypoints = toKeyPoints(viewOf(nb::cast<Array>(rows), "keypoints"));
}

}  // namespace iib_python
