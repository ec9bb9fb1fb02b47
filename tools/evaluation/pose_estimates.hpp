// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "common/views.hpp"
#include "detectors.hpp"

namespace iib_tools {

//! Matches' points, pixels.
struct Points
{
    std::vector<cv::Point2d> reference, target;
};

//! What an estimate from matches errs, infinite where there is none, and how many of them agree with it.
struct Outcome
{
    double error;
    int inliers;
};

//! Mutual nearest neighbours, and their distances over those of the second neighbours.
std::vector<cv::DMatch> mutualMatches(
        const Described& reference, const Described& target, std::vector<float>& ratios);
std::vector<cv::DMatch> underRatio(
        const std::vector<cv::DMatch>& matches, const std::vector<float>& ratios, float most);
//! Mutual nearest neighbours under a ratio: .92 for IIB, .9 for other bits, .8 for numbers.
std::vector<cv::DMatch> mutualRatioMatches(const Described& reference, const Described& target);
Points pointsOf(const std::vector<cv::DMatch>& matches, const Described& reference, const Described& target);
//! The same with the target's points refined, and with the matches that these lead to if they are propagated.
Points refined(const cv::Mat& referenceImage, const cv::Mat& targetImage, std::vector<cv::DMatch> matches,
        const Described& reference, const Described& target, bool propagated);

Outcome byFindRelativePose(const Points& points, const ViewPair& pair);
Outcome byMagsac(const Points& points, const ViewPair& pair, double threshold);

//! Two images matched from their pixels on, as one would match a single pair.
struct PairMethod
{
    std::string name;
    bool slow;  //!< takes many seconds a pair
    //! Matched points of two CV_8UC1 images; whether the method calls them significant, which matchViews alone decides.
    std::function<bool(const cv::Mat&, const cv::Mat&, Points&)> match;
};

/** matchViews; the recommended chain, upright and propagated; SIFT and ORB, mutual under a ratio, with so many points an image; and
SIFT with so many points in each view of cv::AffineFeature. */
std::vector<PairMethod> pairMethods(int points);

}  // namespace iib_tools
