// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "keypoints.hpp"

#include "opencv2/iib.hpp"

namespace iib_python {

/** @brief A detector of Python, for instance of a foreign cv2, as this OpenCV's Feature2D.

`function(image, mask or None)` gives rows of keypoints (keypoints.hpp). Only arrays cross; the image that it gets is
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

    void detect(cv::InputArray image, std::vector<cv::KeyPoint>& keypoints, cv::InputArray mask) CV_OVERRIDE;
    bool empty() const CV_OVERRIDE { return false; }
    cv::String getDefaultName() const CV_OVERRIDE { return "Feature2D." + name; }

private:
    nb::object function;
    std::string name;
};

}  // namespace iib_python
