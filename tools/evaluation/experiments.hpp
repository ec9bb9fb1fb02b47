// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "common/dataset.hpp"

namespace iib_tools {

//! Files `<set>/<sequence>/<image>.csv`, and .npy of descriptors, of a detector.
struct KeypointFolder
{
    std::string name, folder;
};

struct Options
{
    std::vector<std::string> roots;        //!< folders of sequences and list files
    std::string out;                       //!< folder of the results, made if need be
    int points = 1000;                     //!< keypoints an image
    double tolerance = 3;                  //!< pixels
    int worst = 5;                         //!< worst and best pairs a set to draw; 0: no pictures
    std::vector<std::string> experiments;  //!< names of experiments to run; empty: all
    std::vector<std::string> saved;        //!< files of saved IIB extractors to compare
    std::vector<std::string> detectors;    //!< of OpenCV's; empty: all
    std::vector<KeypointFolder> keypoints;
    std::string network;  //!< ONNX file of a keypoint detector, or empty
    std::string compare;  //!< list file of pairs to draw the matches of several descriptors on, or empty
};

/** Each experiment appends to `<out>/<name>.csv` what is not there yet.
@return the number of pairs that were skipped because something was broken. */
int fixedPoints(const Options& options, const std::vector<ImagePair>& pairs);
//! Of pairs whose light changes, as the paper's.
int detectedPoints(const Options& options, const std::vector<ImagePair>& pairs);
/** Homographies of the pairs, epipolar geometry of those with correspondences, and poses of the views below the roots
(common/views.hpp), estimated from matches. */
int wholeTasks(const Options& options, const std::vector<ImagePair>& pairs);
int matchingStudy(const Options& options, const std::vector<ImagePair>& pairs);
int robustness(const Options& options, const std::vector<ImagePair>& pairs);
//! What a ratio test leaves of the right matches of the presets, for AKAZE's points detected in both images.
int ratios(const Options& options, const std::vector<ImagePair>& pairs);
int cost(const Options& options, const std::vector<ImagePair>& pairs);
//! Pictures of the worst and best pairs of each set, by recall in `<out>/fixed_points.csv`.
int pictures(const Options& options, const std::vector<ImagePair>& pairs);
//! Pictures of the matches of IIB and others on the pairs of Options::compare, at detected points.
int comparison(const Options& options, const std::vector<ImagePair>& pairs);

//! Columns of `<out>/fixed_points.csv`.
std::vector<std::string> fixedPointsColumns();

//! Names of the experiments in the order in which evaluate runs them.
std::vector<std::string> experimentNames();

/** Runs the experiments. @return how many tasks were skipped.
@throws cv::Exception if there is nothing to evaluate, no image pair can be read, an experiment is unknown, or the folder
holds results of other settings. */
int evaluate(const Options& options);

}  // namespace iib_tools
