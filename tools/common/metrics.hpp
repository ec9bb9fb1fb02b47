// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "opencv2/core.hpp"
#include "opencv2/core/types.hpp"

namespace iib_tools {

//! Outcome of one image pair (paper, "Datasets and Metrics").
struct Counts
{
    int correct;          //!< putative matches that agree with the homography
    int putative;         //!< mutual nearest neighbours
    int correspondences;  //!< keypoints of the reference with a true partner in the target
};

//! correct / putative, as in the paper; 0 without putative matches.
double precision(const Counts& counts);
//! correct / correspondences; 0 without correspondences.
double recall(const Counts& counts);

//! Mutual nearest neighbours by BFMatcher with a norm.
std::vector<cv::DMatch> mutualMatches(const cv::Mat& query, const cv::Mat& train, int norm);

//! The point mapped by the homography, pixels; infinite if the map is not defined there.
cv::Point2d project(const cv::Matx33d& homography, const cv::Point2d& point);

//! Distance in the target, in pixels, between the projection of `from` and `to`.
double projectionError(const cv::Matx33d& homography, const cv::Point2d& from, const cv::Point2d& to);

//! The scale of the homography at a point: the square root of the Jacobian's determinant.
double localScale(const cv::Matx33d& homography, const cv::Point2d& point);

//! Whether each match (query: reference, train: target) is within tolerance pixels.
std::vector<bool> correctByLocation(const std::vector<cv::DMatch>& matches,
        const std::vector<cv::KeyPoint>& reference, const std::vector<cv::KeyPoint>& target,
        const cv::Matx33d& homography, double tolerance);

//! @param correct whether each match is correct.
Counts countsOf(const std::vector<bool>& correct, int correspondences);

/** Whether two regions correspond: their centres are within tolerance pixels in the target, and their overlap error is
below 50 %, the benchmark's limit for descriptors. The overlap error is 1 - intersection / union of concentric circles
with diameters KeyPoint::size, the reference's projected. */
bool correspond(const cv::KeyPoint& reference, const cv::KeyPoint& target, const cv::Matx33d& homography,
        double tolerance);

//! The largest number of correspondences that use each keypoint at most once.
int countCorrespondences(const std::vector<cv::KeyPoint>& reference, const std::vector<cv::KeyPoint>& target,
        const cv::Matx33d& homography, double tolerance);

}  // namespace iib_tools
