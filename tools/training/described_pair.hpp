// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "samples.hpp"

namespace iib_tools {

//! Two images, and where points of the reference are in the target: behind the relief, if there is one, and then the homography.
struct Sample
{
    LoadedPair pair;
    cv::Ptr<Relief> relief;
};

//! The evaluation's fixed points; the sample has no relief.
DescribedPair describeFixed(
        const std::string& scene, const LoadedPair& pair, const cv::Ptr<cv::Feature2D>& extractor);

//! Points that HessianDetector finds in each image.
DescribedPair describeDetected(
        const std::string& scene, const Sample& sample, const cv::Ptr<cv::Feature2D>& extractor);

}  // namespace iib_tools
