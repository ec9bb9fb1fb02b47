// SPDX-License-Identifier: Apache-2.0
#include "view_matches.hpp"

#include "../common/points.hpp"
#include "../verdict/verdict.hpp"
#include "../verdict/support.hpp"
#include "two_view_geometry.hpp"
#include "view_search.hpp"

namespace cv::iib {
namespace {

const double DECISIVE = -25;            // log10 of false alarms below which the search ends
const int LEAST_CLEAR = 100;            // matches: propagation of one wrong match may give fewer
const double SHARE_CLEAR = .6;          // of matches with supporting neighbours: decisive without a geometry
const double SHARE_INLIERS = .8;        // of the matches: with fewer, inliers alone are propagated again
const int MOST_IMPROVED = 2;            // rounds
const int SMALL = 480, WORKING = 1024;  // pixels of the longest side of a view

std::vector<Point2d> placesOf(const Mat& points, const std::vector<uchar>& marks)
{
    std::vector<Point2d> chosen;
    for (int i = 0; i < points.rows; i++)
        if (marks.empty() || marks[i])
            chosen.push_back(points.at<Point2f>(i));
    return chosen;
}

//! Propagated matches of two views, in pixels of the views.
struct Propagated
{
    std::vector<DMatch> matches;
    Mat points1, points2, covariances, similarities;

    Propagated(const DescribedView& first, const DescribedView& second, const std::vector<DMatch>& given)
        : matches(given)
    {
        propagateMatches(first.prepared, first.keypoints, second.prepared, second.keypoints, matches, points1,
                points2, covariances, similarities);
    }

    TwoViewGeometry geometry() const
    {
        Mat doubles1, doubles2;
        points1.convertTo(doubles1, CV_64F);
        points2.convertTo(doubles2, CV_64F);
        return TwoViewGeometry(doubles1, doubles2);
    }
};

Mat allMoved(const Matx33d& by, const Mat& points)
{
    Mat result(points.rows, 2, CV_32F);
    for (int i = 0; i < points.rows; i++)
        result.at<Point2f>(i) = moved(by, points.at<Point2f>(i));
    return result;
}

//! Converts propagated matches to pixels of the images.
ViewMatches inImages(const Propagated& propagated, const DescribedView& first, const DescribedView& second)
{
    const Matx33d back1 = first.fromImage.inv(), back2 = second.fromImage.inv();
    const Matx22d J = back2.get_minor<2, 2>(0, 0);
    ViewMatches found;
    found.points1 = allMoved(back1, propagated.points1);
    found.points2 = allMoved(back2, propagated.points2);
    found.covariances = propagated.covariances;
    found.similarities = propagated.similarities;
    for (int i = 0; i < found.covariances.rows; i++)
    {
        Vec3f& c = found.covariances.at<Vec3f>(i);
        const Matx22d there = J * Matx22d(c[0], c[1], c[1], c[2]) * J.t();
        c = Vec3d(there(0, 0), there(0, 1), there(1, 1));
    }
    return found;
}

//! @param areImages whether the views are the images themselves: then support by neighbours can be decisive alone.
ViewMatches matchTwoViews(const DescribedView& first, const DescribedView& second, bool areImages)
{
    const std::vector<DMatch> given = matchesOf(first, second);
    Propagated propagated(first, second, given);
    ViewMatches found = inImages(propagated, first, second);
    if (areImages)
    {
        const std::vector<Point2d> places1 = placesOf(found.points1, {}),
                                   places2 = placesOf(found.points2, {});
        const Support support = Support::of(places1, places2);
        if (found.points1.rows >= LEAST_CLEAR && support.share() > SHARE_CLEAR &&
                agreeFarApart(places1, places2, support.map))
        {
            found.map = support.map;
            found.logFalseAlarms = -std::numeric_limits<double>::infinity();
            found.inliers = support.share() * found.points1.rows;
            return found;
        }
    }
    TwoViewGeometry geometry = propagated.geometry();
    if (geometry.logFalseAlarms < Verdict::CERTAIN && geometry.count() < SHARE_INLIERS * found.points1.rows)
    {
        // In repeated patterns wrong matches propagate too, but they seldom agree with one geometry.
        std::vector<DMatch> agreeing;
        for (size_t i = 0; i < given.size(); i++)
            if (geometry.inliers[i])
                agreeing.push_back(given[i]);
        Propagated again(first, second, agreeing);
        const TwoViewGeometry geometryAgain = again.geometry();
        if (geometryAgain.count() > geometry.count())
        {
            found = inImages(again, first, second);
            std::swap(propagated, again);
            geometry = geometryAgain;
        }
    }
    if (!areImages && (areOneStructure(placesOf(propagated.points1, geometry.inliers)) ||
                              areOneStructure(placesOf(propagated.points2, geometry.inliers))))
        return found;
    if (geometry.count() == 0)
        return found;
    const std::vector<Point2d> places1 = placesOf(found.points1, geometry.inliers),
                               places2 = placesOf(found.points2, geometry.inliers);
    const Matx33d map = Support::of(places1, places2).map;
    if (determinant(map) <= 0 || !agreeFarApart(places1, places2, map))
        return found;
    found.map = map;
    found.logFalseAlarms = geometry.logFalseAlarms;
    found.inliers = geometry.count();
    return found;
}

//! Matches the images in the views of a map.
ViewMatches matchInViewsOf(const ImageViews& first, const ImageViews& second, const Matx33d& map)
{
    const ViewPair pair = ViewPair::of(map).within(SMALL, WORKING, first.size(), second.size());
    return matchTwoViews(*first.described(pair.views[0], -1, cornersAround(second.size(), map.inv())),
            *second.described(pair.views[1], (float)pair.angle, cornersAround(first.size(), map)), false);
}

//! Matches again in views of the estimated map, until the map stops changing or inliers are lost.
void improve(const ImageViews& first, const ImageViews& second, Matx33d map, ViewMatches& best)
{
    for (int round = 0; round < MOST_IMPROVED && !haveSimilarViews(best.map, map); round++)
    {
        map = best.map;
        ViewMatches found = matchInViewsOf(first, second, map);
        if (found.inliers <= best.inliers)
            return;
        std::swap(found, best);
    }
}

}  // namespace

bool ViewMatches::isDecisive() const { return logFalseAlarms < DECISIVE; }

ViewMatches matchAsTheyAre(const ImageViews& first, const ImageViews& second)
{
    ViewMatches best = matchTwoViews(*first.described(View()), *second.described(View()), true);
    if (best.isDecisive())
        improve(first, second, Matx33d::eye(), best);
    return best;
}

void searchMatches(const ImageViews& first, const ImageViews& second, double maxTilt, ViewMatches& best)
{
    const int tried = searchViews(first, second, maxTilt, [&](const ViewCandidate& candidate, int) {
        if (haveSimilarViews(candidate.map, Matx33d::eye()))  // matched before the search
            return false;
        ViewMatches found = matchInViewsOf(first, second, candidate.map);
        if (found.isDecisive())
            improve(first, second, candidate.map, found);
        if (found.logFalseAlarms < best.logFalseAlarms)
            std::swap(found, best);
        return best.isDecisive();
    });
    best.logFalseAlarms += std::log10((double)std::max(tried, 1));
}

}  // namespace cv::iib
