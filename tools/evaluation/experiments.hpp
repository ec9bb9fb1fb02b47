// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "common/dataset.hpp"

namespace iib_tools {

struct Options
{
    std::vector<std::string> roots;        //!< folders of sequences
    std::string out;                       //!< folder of the results, made if it is missing
    int points = 1000;                     //!< keypoints an image
    double tolerance = 3;                  //!< pixels
    std::vector<std::string> experiments;  //!< names of experiments to run; empty: all
    std::vector<std::string> saved;        //!< files of saved IIB extractors to compare
    std::vector<std::string> detectors;    //!< of OpenCV's; empty: all
    std::vector<std::string> keypoints;    //!< folders of other detectors' keypoints
    std::vector<std::string> compare;      //!< pairs of images whose matches are listed
};

//! An experiment of README.md. Adds the missing rows of `<out>/<name>.csv`. @return the number of tasks that failed
typedef int ExperimentFunction(const Options& options, const std::vector<ImagePair>& pairs);
ExperimentFunction fixedPoints, detectedPoints, matching, robustness, comparison;

/** Runs the experiments. @return how many tasks were skipped.
@throws cv::Exception if there is nothing to evaluate, no image pair can be read, an experiment is unknown, or the folder
holds results of other settings. */
int evaluate(const Options& options);

}  // namespace iib_tools
