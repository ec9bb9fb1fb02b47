// SPDX-License-Identifier: Apache-2.0
#include "view_matches.hpp"

#include "../precomp.hpp"
#include "../verdict/support.hpp"
#include "../verdict/verdict.hpp"
#include "opencv2/iib/verdict.hpp"
#include "view_search.hpp"

namespace cv::iib {
namespace {

const int LEAST_CLEAR = 100;      // matches: propagation of one wrong match may give fewer
const double SHARE_CLEAR = .6;    // of matches with supporting neighbours: decisive without a geometry
const double SHARE_INLIERS = .8;  // of the matches: with fewer, inliers alone are propagated again
const int MOST_IMPROVED = 2;      // rounds
const double THRESHOLD = 1.5;     // pixels from the epipolar line, or from the point mapped by the homography
const double CONFIDENCE = .9999;
const int MOST_TRIALS = 10000;

Points placesOf(const Mat& points, const std::vector<uchar>& marks)
{
    Points chosen;
    for (int i = 0; i < points.rows; i++)
        if (marks.empty() || marks[i])
            chosen.push_back(points.at<Point2f>(i));
    return chosen;
}

//! Propagated matches of two views, in pixels of the views.
ViewMatches propagated(const DescribedView& first, const DescribedView& second, std::vector<DMatch> matches)
{
    ViewMatches found;
    propagateMatches(first.prepared, first.keypoints, second.prepared, second.keypoints, matches,
            found.points1, found.points2, found.covariances, found.similarities);
    return found;
}

//! Converts matches from pixels of the views to pixels of the images.
void convertToImages(const DescribedView& first, const DescribedView& second, ViewMatches& found)
{
    const Matx33d back1 = first.fromImage.inv(), back2 = second.fromImage.inv();
    const Matx22d J = back2.get_minor<2, 2>(0, 0);
    for (int i = 0; i < found.points1.rows; i++)
    {
        Point2f &one = found.points1.at<Point2f>(i), &other = found.points2.at<Point2f>(i);
        one = moved(back1, one);
        other = moved(back2, other);
        Vec3f& c = found.covariances.at<Vec3f>(i);
        const Matx22d there = J * Matx22d(c[0], c[1], c[1], c[2]) * J.t();
        c = Vec3d(there(0, 0), there(0, 1), there(1, 1));
    }
}

//! The inliers of a fundamental matrix or a homography, whichever has fewer false alarms.
struct TwoViewGeometry
{
    std::vector<uchar> inliers;  //!< 1 or 0 for each match; empty if no geometry was found
    double logFalseAlarms = std::numeric_limits<double>::infinity();

    explicit TwoViewGeometry(const ViewMatches& given)
    {
        const Mat &points1 = given.points1, &points2 = given.points2;
        for (bool epipolar : {true, false})
        {
            if (points1.rows < (epipolar ? 8 : 5))
                continue;
            std::vector<uchar> marks;
            try
            {
                if (epipolar)
                    findFundamentalMat(
                            points1, points2, USAC_MAGSAC, THRESHOLD, CONFIDENCE, MOST_TRIALS, marks);
                else
                    findHomography(points1, points2, USAC_MAGSAC, THRESHOLD, marks, MOST_TRIALS, CONFIDENCE);
            }
            catch (const cv::Exception&)  // some versions of OpenCV throw for degenerate points
            {
                continue;
            }
            if ((int)marks.size() != points1.rows)
                continue;
            const double alarms = iib::logFalseAlarms(points1, points2, marks, epipolar, THRESHOLD);
            if (alarms < logFalseAlarms)
            {
                logFalseAlarms = alarms;
                inliers = marks;
            }
        }
    }

    int count() const { return (int)std::count(inliers.begin(), inliers.end(), 1); }
};

//! @param areImages whether the views are the images themselves: then support by neighbours can be decisive alone.
ViewMatches matchTwoViews(const DescribedView& first, const DescribedView& second, bool areImages)
{
    const std::vector<DMatch> given = matchesOf(first, second);
    ViewMatches found = propagated(first, second, given);
    if (areImages)
    {
        const Points places1 = placesOf(found.points1, {}), places2 = placesOf(found.points2, {});
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
    TwoViewGeometry geometry(found);
    if (geometry.logFalseAlarms < Verdict::CERTAIN && geometry.count() < SHARE_INLIERS * found.points1.rows)
    {
        // In repeated patterns wrong matches propagate too, but they seldom agree with one geometry.
        std::vector<DMatch> agreeing;
        for (size_t i = 0; i < given.size(); i++)
            if (geometry.inliers[i])
                agreeing.push_back(given[i]);
        const ViewMatches again = propagated(first, second, agreeing);
        const TwoViewGeometry geometryAgain(again);
        if (geometryAgain.count() > geometry.count())
        {
            found = again;
            geometry = geometryAgain;
        }
    }
    const bool isOneStructure =
            !areImages && (areOneStructure(placesOf(found.points1, geometry.inliers)) ||
                                  areOneStructure(placesOf(found.points2, geometry.inliers)));
    convertToImages(first, second, found);
    if (isOneStructure || geometry.count() == 0)
        return found;
    const Points places1 = placesOf(found.points1, geometry.inliers),
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
    const ViewPair pair = ViewPair::of(map).within(WORKING_SIZE, first.size(), second.size(), map);
    return matchTwoViews(*first.described(pair.views[0], -1, cornersAround(second.size(), map.inv())),
            *second.described(pair.views[1], (float)pair.angle, cornersAround(first.size(), map)), false);
}

/** Matches again in views of the estimated map, until the map stops changing or inliers are lost.
@param always whether at least once: whole images were matched, of which one shows a part of the other. */
void improve(const ImageViews& first, const ImageViews& second, Matx33d map, bool always, ViewMatches& best)
{
    for (int round = 0; round < MOST_IMPROVED && (always || !haveSimilarViews(best.map, map)); round++)
    {
        always = false;
        map = best.map;
        ViewMatches found = matchInViewsOf(first, second, map);
        if (found.inliers <= best.inliers)
            return;
        std::swap(found, best);
    }
}

}  // namespace

ViewMatches matchInSomeViews(const ImageViews& first, const ImageViews& second, double maxTilt)
{
    ViewMatches best = matchTwoViews(*first.described(View()), *second.described(View()), true);
    if (best.isDecisive())
        improve(first, second, Matx33d::eye(), isMuchLarger(first, second), best);
    if (best.isDecisive())
        return best;
    const int tried = searchViews(first, second, maxTilt, [&](const ViewCandidate& candidate, int) {
        ViewMatches found = matchInViewsOf(first, second, candidate.map);
        if (found.isDecisive())
            improve(first, second, candidate.map, false, found);
        if (found.logFalseAlarms < best.logFalseAlarms)
            std::swap(found, best);
        return best.isDecisive();
    });
    best.logFalseAlarms += std::log10((double)std::max(tried, 1));
    return best;
}

}  // namespace cv::iib
