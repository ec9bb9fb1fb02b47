// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "opencv2/core.hpp"
#include "opencv2/core/types.hpp"

namespace iib_tools {

//! Outcome of one image pair (paper, "Datasets and Metrics").
struct Counts
{
    int correct;          //!< putative matches that the homography confirms
    int putative;         //!< mutual best matches
    int correspondences;  //!< keypoints of the reference that have a true partner in the target
};

//! correct / putative, equation of the paper; 0 without putative matches.
double precision(const Counts& counts);
//! correct / correspondences; 0 without correspondences.
double recall(const Counts& counts);

//! Pairs of rows that are each other's nearest; norm as BFMatcher's, whose matches these are.
std::vector<cv::DMatch> mutualMatches(const cv::Mat& query, const cv::Mat& train, int norm);

//! Where the homography takes a point, in pixels; infinite if it goes through infinity.
cv::Point2d project(const cv::Matx33d& homography, const cv::Point2d& point);

//! Distance in the target, in pixels, between the projection of `from` and `to`.
double projectionError(const cv::Matx33d& homography, const cv::Point2d& from, const cv::Point2d& to);

//! How much longer a short line at the point becomes: the square root of the Jacobian's determinant.
double localScale(const cv::Matx33d& homography, const cv::Point2d& point);

//! For each match (query: reference, train: target), whether it lies within tolerance pixels.
std::vector<bool> correctByLocation(const std::vector<cv::DMatch>& matches,
        const std::vector<cv::KeyPoint>& reference, const std::vector<cv::KeyPoint>& target,
        const cv::Matx33d& homography, double tolerance);

//! Counts of matches judged as `correct`, one element a match.
Counts countsOf(const std::vector<bool>& correct, int correspondences);

/** Whether two regions correspond: centres within tolerance pixels in the target, and the overlap error of
the regions (1 - intersection / union, the reference's one projected, compared as circles about one centre)
below 50 %, the benchmark's limit for descriptors. KeyPoint::size is the diameter. */
bool correspond(const cv::KeyPoint& reference, const cv::KeyPoint& target, const cv::Matx33d& homography,
        double tolerance);

//! The largest number of correspondences with every keypoint in one of them at most.
int countCorrespondences(const std::vector<cv::KeyPoint>& reference, const std::vector<cv::KeyPoint>& target,
        const cv::Matx33d& homography, double tolerance);

}  // namespace iib_tools
