// SPDX-License-Identifier: Apache-2.0

#include "metrics.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "opencv2/features2d.hpp"
#include "opencv2/iib.hpp"

namespace iib_tools {
namespace {

//! Kuhn's augmenting path: finds a partner for `from`, changing earlier choices if necessary.
bool findPartner(int from, const std::vector<std::vector<int>>& candidates, std::vector<int>& partner,
        std::vector<int>& visitedBy, int round)
{
    for (int to : candidates[from])
    {
        if (visitedBy[to] == round)
            continue;
        visitedBy[to] = round;
        if (partner[to] < 0 || findPartner(partner[to], candidates, partner, visitedBy, round))
        {
            partner[to] = from;
            return true;
        }
    }
    return false;
}

}  // namespace

double precision(const Counts& counts)
{
    return counts.putative > 0 ? double(counts.correct) / counts.putative : 0;
}

double recall(const Counts& counts)
{
    return counts.correspondences > 0 ? double(counts.correct) / counts.correspondences : 0;
}

std::vector<cv::DMatch> mutualMatches(const cv::Mat& query, const cv::Mat& train, int norm)
{
    std::vector<cv::DMatch> matches;
    if (query.empty() || train.empty())
        return matches;
    if (norm == cv::NORM_HAMMING)
        cv::iib::HierarchicalMatcher::create({query.cols}, cv::iib::HierarchicalMatcher::EXACT, 0, true)
                ->match(query, train, matches);
    else
        cv::BFMatcher(norm, true).match(query, train, matches);
    return matches;
}

cv::Point2d project(const cv::Matx33d& homography, const cv::Point2d& point)
{
    const cv::Vec3d p = homography * cv::Vec3d(point.x, point.y, 1);
    if (p[2] == 0)
        return cv::Point2d(std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity());
    return cv::Point2d(p[0] / p[2], p[1] / p[2]);
}

double projectionError(const cv::Matx33d& homography, const cv::Point2d& from, const cv::Point2d& to)
{
    const cv::Point2d d = project(homography, from) - to;
    return std::sqrt(d.x * d.x + d.y * d.y);
}

double localScale(const cv::Matx33d& homography, const cv::Point2d& point)
{
    const double w = homography(2, 0) * point.x + homography(2, 1) * point.y + homography(2, 2);
    return std::sqrt(std::abs(cv::determinant(homography) / (w * w * w)));
}

std::vector<bool> correctByLocation(const std::vector<cv::DMatch>& matches,
        const std::vector<cv::KeyPoint>& reference, const std::vector<cv::KeyPoint>& target,
        const cv::Matx33d& homography, double tolerance)
{
    std::vector<bool> correct;
    for (const cv::DMatch& m : matches)
        correct.push_back(
                projectionError(homography, reference[m.queryIdx].pt, target[m.trainIdx].pt) <= tolerance);
    return correct;
}

Counts countsOf(const std::vector<bool>& correct, int correspondences)
{
    Counts counts;
    counts.correct = int(std::count(correct.begin(), correct.end(), true));
    counts.putative = int(correct.size());
    counts.correspondences = correspondences;
    return counts;
}

bool correspond(const cv::KeyPoint& reference, const cv::KeyPoint& target, const cv::Matx33d& homography,
        double tolerance)
{
    if (!(projectionError(homography, reference.pt, target.pt) <= tolerance))
        return false;
    const double ratio = reference.size * localScale(homography, reference.pt) / target.size;
    return std::min(ratio * ratio, 1 / (ratio * ratio)) > 0.5;
}

int countCorrespondences(const std::vector<cv::KeyPoint>& reference, const std::vector<cv::KeyPoint>& target,
        const cv::Matx33d& homography, double tolerance)
{
    std::vector<std::vector<int>> candidates(reference.size());
    for (size_t i = 0; i < reference.size(); i++)
        for (size_t j = 0; j < target.size(); j++)
            if (correspond(reference[i], target[j], homography, tolerance))
                candidates[i].push_back(int(j));

    std::vector<int> partner(target.size(), -1), visitedBy(target.size(), -1);
    int count = 0;
    for (size_t i = 0; i < reference.size(); i++)
        count += findPartner(int(i), candidates, partner, visitedBy, int(i));
    return count;
}

}  // namespace iib_tools
