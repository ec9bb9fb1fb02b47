// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "common/views.hpp"
#include "detectors.hpp"

namespace iib_tools {

//! Two views, and which of three other lights the second image is put into; -1: as it is.
struct LitPair
{
    ViewPair views;
    int light;
};

/** Adds to each pair in one light the same in another, whose set ends in " relit": darker from left to right with deep
shadows; bright; or dark from above; each with a sensor's noise. */
std::vector<LitPair> withRelit(const std::vector<ViewPair>& pairs);

//! What an experiment does with the points of a pair's images that one detector found and one descriptor described.
struct ViewExperiment
{
    std::function<bool(const ViewPair&, const Detector&)> isDone;
    std::function<void(const ViewPair&, const Detector&, const cv::Mat& reference, const cv::Mat& target,
            const Described&, const Described&)>
            judge;
};

//! Runs it on all pairs and detectors that are not done. @return how many pairs were skipped.
int runOnViews(const std::string& title, const std::vector<LitPair>& pairs,
        const std::vector<Detector>& detectors, const ViewExperiment& experiment);

}  // namespace iib_tools
