// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>

#include "configurations.hpp"
#include "common/dataset.hpp"
#include "common/keypoints.hpp"
#include "common/metrics.hpp"
#include "experiments.hpp"
#include "results.hpp"

namespace iib_tools {

//! Seed points of a reference image, detected once by each detector.
class SeedSource
{
public:
    SeedSource(const cv::Mat& reference, int count) : reference_(reference), count_(count) {}

    //! At most `count` points inside a target, with the configuration's seedSize unless that is 0.
    SeedPoints seeds(const Configuration& configuration, cv::Size targetSize, const cv::Matx33d& homography);

private:
    cv::Mat reference_;
    int count_;
    std::map<std::string, std::vector<cv::KeyPoint>> points_;  // by detector
};

//! Describes an image's points, and removes points that the descriptor drops. @param maps of Configuration::extraNames
cv::Mat describe(const Configuration& configuration, const cv::Mat& image,
        const std::map<std::string, cv::Mat>& maps, std::vector<cv::KeyPoint>& points);

//! The columns of fixed_points.csv and robustness.csv; the first five name a row.
Fields seededColumns();

}  // namespace iib_tools
