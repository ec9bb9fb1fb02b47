// SPDX-License-Identifier: Apache-2.0

#include "pose_search.hpp"

#include <algorithm>
#include <limits>
#include <set>

#include "guided_matches.hpp"
#include "../verdict/verdict.hpp"

namespace cv::iib {
namespace {

constexpr size_t SUREST = 300;  // matches of the fewest different bits, among which the pose is looked for
constexpr double MAX_ERROR = .006;   // of the longer side, from where the pose has an inlier's point
constexpr double LEAST_SHARE = .02;  // in an unknown place a few matches agree by chance
constexpr double MAX_BOUND = .1;     // of the distance to the points: three standard deviations of the place
constexpr size_t WORTH = 16;         // matches with an image of the map, for which they are refined
constexpr int ROUNDS = 4;            // what agrees is looked for again after each refinement
constexpr int GUIDED_ROUNDS = 8;     // at most, along the pose
constexpr double STILL = .1;         // pixels that what is seen moves by a look, if it is the last one
constexpr int LINE_ROUNDS = 2;       // lines are looked for again after the first refinement by them

//! Keypoints that match a point in several images of the map count once.
std::vector<Match> withoutRepeated(std::vector<Match> matches)
{
    const auto key = [](const Match& m) { return std::make_pair(m.keypoint, m.number); };
    std::stable_sort(
            matches.begin(), matches.end(), [&](const Match& a, const Match& b) { return key(a) < key(b); });
    const auto repeated = [&](const Match& a, const Match& b) { return key(a) == key(b); };
    matches.erase(std::unique(matches.begin(), matches.end(), repeated), matches.end());
    return matches;
}

int keypointsOf(const std::vector<Match>& matches)
{
    std::set<int> keypoints;
    for (const Match& m : matches)
        keypoints.insert(m.keypoint);
    return int(keypoints.size());
}

//! A pose in the making, in its Frame's axes. Each step says whether there still is one; if not, the location's reason says why.
class PoseSearch
{
public:
    PoseSearch(const std::vector<Match>& all, const Map& map, PreparedPictures& pictures,
            const Camera& camera, LocatedImage& found)
        : map_(map), views_{map, pictures, found.prepared}, found_(found), location_(found.location),
          frame_(all), lens_(camera), limit_(MAX_ERROR * std::max(camera.size.width, camera.size.height)),
          all_(all)
    {
        for (Match& m : all_)
            m.point = frame_.toLocal(m.point);
        matches_ = withoutRepeated(all_);
        location_.matches = int(matches_.size());
    }

    //! By the keypoints that match, which are refined on the way.
    bool byKeypoints()
    {
        std::vector<Match> surest;
        for (size_t i : best(matches_.size(), SUREST,
                     [&](size_t a, size_t b) { return matches_[a].bits < matches_[b].bits; }))
            surest.push_back(matches_[i]);
        location_.reason = "too few matches agree";
        if (!poseByRansac(surest, lens_, limit_, pose_))
            return false;
        for (int round = 0; round < ROUNDS; round++)
        {
            if (round > 0 && !refine(inliers_))
                return false;
            inliers_ = near(matches_);
            location_.inliers = keypointsOf(inliers_);
            if (location_.inliers < LEAST_INLIERS + LEAST_SHARE * double(location_.matches))
                return false;
            if (round == 0 && !isMoreThanChance())
            {
                location_.reason = "the matches that agree are no more than chance may give";
                return false;
            }
            if (round == 1)
            {
                if (found_.prepared.image.pixels.empty())  // else it was for a prior
                    found_.prepared = PreparedPicture(found_.features.picture);
                refineAgainstViews(inliers_, views_, WORTH);
                matches_ = inliers_;
            }
        }
        return true;
    }

    //! And by what is seen where the pose has the map's points.
    bool byGuidedMatches()
    {
        double moved = STILL;
        for (int look = 0; look < GUIDED_ROUNDS && !(moved < STILL); look++)
        {
            const Affine3d before = pose_;
            used_ = near(matches_);
            for (const Match& m : near(guidedMatches(views_, found_.compared, lens_, frame_, pose_)))
                used_.push_back(m);
            learnDeviation(used_, lens_, pose_);
            if (!refine(used_))
                return false;
            inliers_ = near(used_);
            moved = lens_.matrix()(0, 0) * distance(pose_, before, depth());
        }
        return true;
    }

    bool byLines()
    {
        for (int round = 0; round < LINE_ROUNDS && !found_.segments.places.empty(); round++)
        {
            used_ = inliers_;
            for (const Match& m :
                    lineMatches(map_, found_.compared, found_.segments, lens_, frame_, pose_, limit_))
                used_.push_back(m);
            if (!refine(used_))
                return false;
            inliers_ = near(inliers_);
        }
        return true;
    }

    bool isCertain()
    {
        if (!determined(clusteredCovariance(used_, lens_, pose_, covariance_)))
            return false;
        Vec3d variances;
        eigen(covariance_.get_minor<3, 3>(0, 0), variances);
        location_.reason = "the pose is uncertain";
        return 3 * std::sqrt(variances[0]) <= MAX_BOUND * depth();
    }

    void writeResult() const
    {
        location_.found = true;
        location_.reason = "";
        location_.cameraFromWorld = frame_.toWorld(pose_);
        location_.covariance = frame_.toWorld(covariance_);
        for (const Match& m : inliers_)
            if (m.keypoint >= 0)
            {
                location_.pixels.push_back(m.pixel);
                location_.points.push_back(map_.points[size_t(m.number)]);
            }
        found_.depth = medianDistance(inCamera(location_.points, location_.cameraFromWorld));
        found_.agreeing = near(all_);
    }

private:
    std::vector<Match> near(const std::vector<Match>& matches) const
    {
        return within(limit_, matches, lens_, pose_);
    }

    //! Whether the matches that agree are not what points of different matches might give, or are in a few places alone.
    bool isMoreThanChance() const
    {
        const int sampleSize = 4;
        const std::vector<Point2d> mapped = lens_.project(inCamera(pointsOf(matches_), pose_));
        const auto errorOf = [&](int pixel, int point) {
            const Match& match = matches_[size_t(pixel)];
            const double error = norm(match.errorProjection * (mapped[size_t(point)] - match.pixel));
            return std::isnan(error) ? std::numeric_limits<double>::infinity() : error * error;
        };
        Mat pixels(int(matches_.size()), 2, CV_64F);
        std::vector<double> squared;
        for (int i = 0; i < pixels.rows; i++)
        {
            pixels.at<Point2d>(i) = matches_[size_t(i)].pixel;
            squared.push_back(errorOf(i, i));
        }
        const Verdict verdict(pixels, pixels);
        return verdict.logFalseAlarms(squared, errorsOfWrongMatches(verdict, errorOf), Verdict::FROM_POINT,
                       sampleSize, {limit_}) < Verdict::CERTAIN;
    }

    double depth() const { return medianDistance(inCamera(pointsOf(inliers_), pose_)); }

    bool refine(const std::vector<Match>& matches)
    {
        return determined(refinePose(matches, lens_, pose_, covariance_));
    }

    bool determined(bool is)
    {
        if (!is)
            location_.reason = "the points do not determine the pose";
        return is;
    }

    const Map& map_;
    Views views_;
    LocatedImage& found_;
    Location& location_;
    const Frame frame_;
    const Lens lens_;
    const double limit_;                 //!< pixels
    std::vector<Match> all_, matches_;   //!< every code's; each keypoint's once
    std::vector<Match> inliers_, used_;  //!< near the pose; that made it
    Affine3d pose_;
    Matx66d covariance_;
};

}  // namespace

void findPose(const std::vector<Match>& matches, const Map& map, PreparedPictures& pictures,
        const Camera& camera, LocatedImage& found)
{
    PoseSearch search(matches, map, pictures, camera, found);
    if (search.byKeypoints() && search.byGuidedMatches() && search.byLines() && search.isCertain())
        search.writeResult();
}

}  // namespace cv::iib
