// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>

#include "configurations.hpp"
#include "common/keypoints.hpp"
#include "common/metrics.hpp"

namespace iib_tools {

//! Two images, seed points of the reference's and where they really are in the target.
struct SeededPair
{
    cv::Mat reference, target;
    std::vector<cv::Mat> referenceExtra, targetExtra;  //!< maps for the configuration, if it takes any
    cv::Matx33d homography;
    SeedPoints seeds;
};

//! Seed points in one reference image, detected once for all configurations that ask for the same.
class SeedSource
{
public:
    //! Of count points at most.
    SeedSource(const cv::Mat& reference, int count) : reference_(reference), count_(count) {}

    //! For one target; of the configuration's seedSize unless that is 0.
    SeedPoints seeds(const Configuration& configuration, cv::Size targetSize, const cv::Matx33d& homography);

private:
    cv::Mat reference_;
    int count_;
    std::map<std::string, std::vector<cv::KeyPoint>> points_;  // by detector
};

//! Descriptions of both images and their mutual matches.
struct SeededMatches
{
    Description reference, target;
    std::vector<cv::DMatch> matches;
    std::vector<bool> correct;
    Counts counts;  //!< every seed is a correspondence, whether the descriptor kept it or not
};
SeededMatches matchSeeds(const Configuration& configuration, const SeededPair& pair, double tolerance);

}  // namespace iib_tools
