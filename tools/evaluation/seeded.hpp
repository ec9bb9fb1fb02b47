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

//! Describes an image's points, of which it leaves those that the descriptor keeps; maps are those of extraNames.
cv::Mat describe(const Configuration& configuration, const cv::Mat& image,
        const std::map<std::string, cv::Mat>& maps, std::vector<cv::KeyPoint>& points);

//! The columns that addSeededTask fills; `set` to `configuration`, the first five, name a row.
Fields seededColumns();

/** Adds a task that appends, for each configuration that has no row yet, what the mutual matches of its descriptors make of its
seeds: every seed is a correspondence, whether the descriptor kept it or not.
@param key set, sequence, target and kind. @param load gives the images. */
void addSeededTask(const Options& options, const Fields& key,
        const std::vector<Configuration>& configurations, const std::function<LoadedPair()>& load,
        ResultTable& table, std::vector<Task>& tasks);

}  // namespace iib_tools
