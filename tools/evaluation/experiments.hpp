// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "common/dataset.hpp"

namespace iib_tools {

struct Options
{
    std::vector<std::string> roots;        //!< folders of sequences
    std::string out;                       //!< folder of the results, made if need be
    int points = 1000;                     //!< keypoints an image
    double tolerance = 3;                  //!< pixels
    std::vector<std::string> experiments;  //!< names of experiments to run; empty: all
    std::vector<std::string> saved;        //!< files of saved IIB extractors to compare
    std::vector<std::string> detectors;    //!< of OpenCV's; empty: all
    std::vector<std::string> keypoints;    //!< folders of other detectors' keypoints
    std::vector<std::string> pairs;        //!< lists of pairs below the roots, for `estimators` alone
    std::vector<std::string> compare;      //!< pairs of images to list the matches of several descriptors of
};

/** Each experiment appends to `<out>/<name>.csv` what is not there yet.
@return the number of pairs that were skipped because something was broken. */
int fixedPoints(const Options& options, const std::vector<ImagePair>& pairs);
//! Of pairs whose light changes, as the paper's.
int detectedPoints(const Options& options, const std::vector<ImagePair>& pairs);
//! Poses of the views below the roots (common/views.hpp), or of Options::pairs, from plain and refined matches by several estimators;
//! `<out>/matched_points.csv` holds the matches for others.
int estimators(const Options& options, const std::vector<ImagePair>& pairs);
/** Poses by this library and by other detectors and descriptors, all refined and propagated here, for four ratios and with noise; and, where
views.py wrote depths, in `<out>/neighbours.csv` how many points have the right nearest neighbour. */
int controls(const Options& options, const std::vector<ImagePair>& pairs);
//! alignImages on pairs whose light changes, the second image moved by a homography, and on images of different scenes.
int alignment(const Options& options, const std::vector<ImagePair>& pairs);
//! HierarchicalMatcher's modes and the paper's thresholds (paper, "Fast Hierarchical vs. Brute-force Matching").
int matching(const Options& options, const std::vector<ImagePair>& pairs);
//! How many of the errors of poses, alignments and refined points are inside what was told of them.
int uncertainty(const Options& options, const std::vector<ImagePair>& pairs);
int robustness(const Options& options, const std::vector<ImagePair>& pairs);
//! matchViews and others on a photograph of each sequence and its view from elsewhere, computed; matchViews on unrelated images.
int warpedViews(const Options& options, const std::vector<ImagePair>& pairs);
//! Of pairs of the kind "marked": the share of correspondences that agree with the fundamental matrix of each method's matches.
int wxbs(const Options& options, const std::vector<ImagePair>& pairs);
//! Matches of IIB and others on the pairs of Options::compare at detected points. Beside the second image, whose name begins
//! with N, there may be its homography, H_N; else the camera stood still.
int comparison(const Options& options, const std::vector<ImagePair>& pairs);

/** Runs the experiments. @return how many tasks were skipped.
@throws cv::Exception if there is nothing to evaluate, no image pair can be read, an experiment is unknown, or the folder
holds results of other settings. */
int evaluate(const Options& options);

}  // namespace iib_tools
