// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <mutex>
#include <string>
#include <vector>

#include "opencv2/core/types.hpp"
#include "opencv2/dnn.hpp"

namespace iib_tools {

struct DeepKeypoints
{
    std::vector<cv::KeyPoint> keypoints;  //!< strongest first, size 1, angle -1
    cv::Mat descriptors;                  //!< CV_32F, unit rows, or empty
};

/** A keypoint network in an ONNX file, run by cv::dnn; tools/evaluation/README.md tells what it may hold. Its input is 1 x 1 x H x W (grey) or 1 x 3 x H x W, values
0 to 1, whichever it accepts. Its outputs are told by their shapes:
 - 1 x 65 x H/8 x W/8: SuperPoint's logits, the last for "none"; maxima within 4 pixels, 4 pixels of border left out;
 - 1 x 1 x H x W or 1 x H x W: a map of scores (ALIKE); maxima within 2 pixels, refined to parts of a pixel;
 - N x 2 or 1 x N x 2: keypoints (x, y) in pixels, or in -1..1 over the image if none is outside of that;
 - N, N x 1 or 1 x N: scores of the keypoints;
 - 1 x D x h x w, D > 1: a map of descriptors; N x D or 1 x N x D, D > 2: descriptors of the keypoints. */
class DeepDetector
{
public:
    //! @throws cv::Exception if the file is no network that gives keypoints for a grey or colour image.
    explicit DeepDetector(const std::string& file);

    //! At most count keypoints of an 8-bit grey image. Calls from several threads wait for each other.
    DeepKeypoints detect(const cv::Mat& image, int count);

    bool hasDescriptors() const { return hasDescriptors_; }

private:
    std::vector<cv::Mat> forward(const cv::Mat& padded);

    std::mutex mutex_;
    cv::dnn::Net net_;
    int channels_;
    bool hasDescriptors_;
};

}  // namespace iib_tools
