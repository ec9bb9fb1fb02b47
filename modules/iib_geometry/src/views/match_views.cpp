// SPDX-License-Identifier: Apache-2.0
#include "opencv2/iib/views.hpp"

#include "../common/points.hpp"
#include "../pose/verdict.hpp"
#include "image_views.hpp"
#include "support.hpp"
#include "two_view_geometry.hpp"
#include "view_search.hpp"

namespace cv::iib {
namespace {

const double DECISIVE = -25;    // logarithm of the number of false alarms below which nothing else is tried
const int LEAST_CLEAR = 50;     // matches that are compared, and
const double SHARE_CLEAR = .6;  // of them that are supported: these are decisive without a geometry
const double SHARE_RIGHT = .8;  // of the matches that agree with a geometry, if few lead to wrong ones
const int MOST_IMPROVED = 2;    // times
const int SMALL = 480, WORKING = 1024;  // pixels of the longest side of a view

std::vector<Point2d> placesOf(const Mat& points, const std::vector<uchar>& marks)
{
    std::vector<Point2d> chosen;
    for (int i = 0; i < points.rows; i++)
        if (marks.empty() || marks[i])
            chosen.push_back(points.at<Point2f>(i));
    return chosen;
}

//! Matches of two images in one pair of views.
struct ViewMatches
{
    Mat points1, points2, covariances, similarities;  //!< as matchViews has them
    double logFalseAlarms = std::numeric_limits<double>::infinity();
    double right = 0;              //!< number of matches that agree
    Matx33d map = Matx33d::eye();  //!< affine, estimated from those that agree

    bool isDecisive() const { return logFalseAlarms < DECISIVE; }
};

//! Propagated matches of two views, in pixels of the views.
struct Propagated
{
    std::vector<DMatch> matches;
    Mat points1, points2, covariances, similarities;

    Propagated(const SeenView& first, const SeenView& second, const std::vector<DMatch>& given)
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

//! In pixels of the images.
ViewMatches inImages(const Propagated& propagated, const SeenView& first, const SeenView& second)
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

//! @param mayBeClear whether matches are decisive that their neighbours support, without a geometry.
ViewMatches matched(const SeenView& first, const SeenView& second, bool mayBeClear)
{
    const std::vector<DMatch> given = matchesOf(first, second);
    Propagated propagated(first, second, given);
    ViewMatches found = inImages(propagated, first, second);
    if (mayBeClear)
    {
        const Support support(placesOf(found.points1, {}), placesOf(found.points2, {}));
        if (support.compared >= LEAST_CLEAR && support.share() > SHARE_CLEAR)
        {
            found.map = support.map;
            found.logFalseAlarms = -std::numeric_limits<double>::infinity();
            found.right = support.share() * found.points1.rows;
            return found;
        }
    }
    TwoViewGeometry geometry = propagated.geometry();
    if (geometry.logFalseAlarms < Verdict::CERTAIN && geometry.count() < SHARE_RIGHT * found.points1.rows)
    {
        // Where a pattern repeats, wrong matches lead to further ones, but seldom to one geometry.
        std::vector<DMatch> agreeing;
        for (size_t i = 0; i < given.size(); i++)
            if (geometry.inliers[i])
                agreeing.push_back(given[i]);
        const Propagated again(first, second, agreeing);
        const TwoViewGeometry geometryAgain = again.geometry();
        if (geometryAgain.count() > geometry.count())
        {
            found = inImages(again, first, second);
            geometry = geometryAgain;
        }
    }
    found.logFalseAlarms = geometry.logFalseAlarms;
    found.right = geometry.count();
    if (found.right > 0)
        found.map =
                Support(placesOf(found.points1, geometry.inliers), placesOf(found.points2, geometry.inliers))
                        .map;
    return found;
}

class ViewMatcherImpl : public ViewMatcher
{
public:
    ViewMatcherImpl(const Mat& image, const Mat& mask, int maxFeatures, double maxTilt)
        : first_(image, mask, maxFeatures), maxFeatures_(maxFeatures), maxTilt_(maxTilt)
    {
    }

    bool match(InputArray image, OutputArray points1, OutputArray points2, OutputArray covariances,
            OutputArray similarities, OutputArray view, InputArray mask, String* reason) const override
    {
        const ImageViews second(image.getMat(), mask.getMat(), maxFeatures_);
        ViewMatches best = matched(*first_.seen(View()), *second.seen(View()), true);
        int tried = 1;
        if (best.isDecisive())
            improve(second, Matx33d::eye(), best);
        else
            searchViews(first_, second, maxTilt_, [&](const ViewCandidate& candidate, int pairs) {
                tried = pairs;
                if (areAlike(candidate.map, Matx33d::eye()))  // which was tried
                    return false;
                ViewMatches found = seenAs(second, candidate.map);
                if (found.isDecisive())
                    improve(second, candidate.map, found);
                if (found.logFalseAlarms < best.logFalseAlarms)
                    std::swap(found, best);
                return best.isDecisive();
            });
        writeRows(best.points1, points1);
        writeRows(best.points2, points2);
        writeRows(best.covariances, covariances);
        writeRows(best.similarities, similarities);
        const bool found = best.logFalseAlarms + std::log10((double)tried) < Verdict::CERTAIN;
        if (reason)
            *reason = found ? ""
                            : format("at most %.0f of %d matches agree, which could be random: the images "
                                     "may not show the "
                                     "same, or from views that differ too much",
                                      best.right, best.points1.rows);
        if (found)
            writeRows(Mat(best.map), view);
        else
            clear(view);
        return found;
    }

private:
    //! Matches in views between which a map leads.
    ViewMatches seenAs(const ImageViews& second, const Matx33d& map) const
    {
        const ViewPair pair = ViewPair::of(map).within(SMALL, WORKING, first_.size(), second.size());
        return matched(*first_.seen(pair.views[0], -1, cornersAround(second.size(), map.inv())),
                *second.seen(pair.views[1], (float)pair.angle, cornersAround(first_.size(), map)), false);
    }

    //! Matches again in views of the map that the matches themselves have, as long as that is another one.
    void improve(const ImageViews& second, Matx33d map, ViewMatches& best) const
    {
        for (int round = 0; round < MOST_IMPROVED && !areAlike(best.map, map); round++)
        {
            map = best.map;
            ViewMatches found = seenAs(second, map);
            if (found.right <= best.right)
                return;
            std::swap(found, best);
        }
    }

    ImageViews first_;
    int maxFeatures_;
    double maxTilt_;
};

}  // namespace

Ptr<ViewMatcher> ViewMatcher::create(InputArray image, int maxFeatures, double maxTilt, InputArray mask)
{
    const double mostTilt = 8;
    if (!(maxTilt >= 1 && maxTilt <= mostTilt))
        CV_Error(Error::StsOutOfRange,
                format("matchViews: maxTilt is %g; it is 1 (no tilted views) to %g", maxTilt, mostTilt));
    return makePtr<ViewMatcherImpl>(image.getMat(), mask.getMat(), maxFeatures, maxTilt);
}

bool matchViews(InputArray image1, InputArray image2, OutputArray points1, OutputArray points2,
        OutputArray covariances, OutputArray similarities, OutputArray view, int maxFeatures, double maxTilt,
        InputArray mask1, InputArray mask2, String* reason)
{
    return ViewMatcher::create(image1, maxFeatures, maxTilt, mask1)
            ->match(image2, points1, points2, covariances, similarities, view, mask2, reason);
}

}  // namespace cv::iib
