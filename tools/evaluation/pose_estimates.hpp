// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "common/views.hpp"
#include "detectors.hpp"

namespace iib_tools {

//! The points of matches, pixels.
struct Points
{
    std::vector<cv::Point2d> reference, target;
};

//! The error of an estimated pose (infinite without a pose) and its number of inliers.
struct Outcome
{
    double error;
    int inliers;
};

//! Mutual nearest neighbours. @param ratios receives each distance over that of the second neighbour
std::vector<cv::DMatch> mutualMatches(
        const Described& reference, const Described& target, std::vector<float>& ratios);
std::vector<cv::DMatch> underRatio(
        const std::vector<cv::DMatch>& matches, const std::vector<float>& ratios, float most);
//! Mutual nearest neighbours under a ratio: .92 for IIB, .9 for other bits, .8 for numbers.
std::vector<cv::DMatch> mutualRatioMatches(const Described& reference, const Described& target);
Points pointsOf(const std::vector<cv::DMatch>& matches, const Described& reference, const Described& target);
//! As pointsOf, with refined points. @param propagated also adds propagated matches
Points refined(const cv::Mat& referenceImage, const cv::Mat& targetImage, std::vector<cv::DMatch> matches,
        const Described& reference, const Described& target, bool propagated);

Outcome byFindRelativePose(const Points& points, const ViewPair& pair);
Outcome byMagsac(const Points& points, const ViewPair& pair, double threshold);

//! A method that matches two images from their pixels.
struct PairMethod
{
    std::string name;
    bool slow;  //!< takes many seconds a pair
    //! Matches two CV_8UC1 images. Returns whether the matches are significant; only matchViews returns false.
    std::function<bool(const cv::Mat&, const cv::Mat&, Points&)> match;
};

/** matchViews; the recommended chain, upright and propagated; SIFT and ORB, mutual under a ratio; and SIFT with cv::AffineFeature.
@param points of an image, or of a view of cv::AffineFeature. */
std::vector<PairMethod> pairMethods(int points);

}  // namespace iib_tools
