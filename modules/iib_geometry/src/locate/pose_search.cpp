// SPDX-License-Identifier: Apache-2.0

#include "pose_search.hpp"

#include <algorithm>
#include <limits>
#include <set>

#include "guided_matches.hpp"
#include "../verdict/verdict.hpp"

namespace cv::iib {
namespace {

constexpr size_t RANSAC_MATCHES = 300;  // matches with the fewest differing bits
constexpr double MAX_ERROR = .006;      // of the longer side: inlier threshold
constexpr double LEAST_SHARE = .02;     // of inliers: in an unknown place a few matches agree by chance
constexpr double MAX_UNCERTAINTY = .1;  // of the scene's distance: three standard deviations of the position
constexpr size_t LEAST_REFINED = 16;    // matches with an image of the map; images with fewer are not refined
// Variances over those that matches show, since matches share errors: of the centre, and of the rotation.
constexpr double OF_CENTRE = 1.5, OF_ROTATION = 2;
constexpr int ROUNDS = 4;         // of refining the pose and finding inliers
constexpr int GUIDED_ROUNDS = 8;  // of guided matching, at most
constexpr double CONVERGED = .1;  // pixels of motion that end guided matching
constexpr int LINE_ROUNDS = 2;    // of matching lines and refining the pose

//! Drops repeated matches of a keypoint with one point, in several images of the map.
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
        if (m.keypoint >= 0)
            keypoints.insert(m.keypoint);
    return int(keypoints.size());
}

double limitOf(const Camera& camera) { return MAX_ERROR * std::max(camera.size.width, camera.size.height); }

//! The matches with the fewest differing bits, for RANSAC.
std::vector<Match> mostSimilar(const std::vector<Match>& matches)
{
    std::vector<Match> similar;
    for (size_t i : best(matches.size(), RANSAC_MATCHES,
                 [&](size_t a, size_t b) { return matches[a].bits < matches[b].bits; }))
        similar.push_back(matches[i]);
    return similar;
}

//! Estimates a pose in steps, in its Frame's axes. Each step returns false if it fails, and sets the location's reason.
class PoseSearch
{
public:
    PoseSearch(const std::vector<Match>& all, const Map& map, PreparedPictures& pictures, LocatedImage& found)
        : map_(map), views_{map, pictures, found.prepared}, found_(found), location_(found.location),
          frame_(all), lens_(found.features.camera), limit_(limitOf(found.features.camera)), all_(all)
    {
        for (Match& m : all_)
            m.point = frame_.toLocal(m.point);
        matches_ = withoutRepeated(all_);
        location_.matches = int(matches_.size());
    }

    //! Estimates the pose from matched keypoints, and refines both.
    bool byKeypoints()
    {
        location_.reason = "too few matches agree";
        if (!poseByRansac(mostSimilar(matches_), lens_, limit_, pose_))
            return false;
        for (int round = 0; round < ROUNDS; round++)
        {
            if (round > 0 && !refine(inliers_))
                return false;
            inliers_ = near(matches_);
            location_.inliers = keypointsOf(inliers_);
            if (location_.inliers < LEAST_INLIERS + LEAST_SHARE * double(location_.matches))
                return false;
            if (round == 0 && !isSignificant())
            {
                location_.reason = "the matches that agree could be random";
                return false;
            }
            if (round == 1)
            {
                if (found_.prepared.image.pixels.empty())  // not yet prepared for a prior
                    found_.prepared = {
                            PreparedImage(found_.features.picture.pixels), found_.features.picture.scale};
                refineAgainstViews(inliers_, views_, LEAST_REFINED);
                matches_ = inliers_;
            }
        }
        return true;
    }

    //! Adds matches found near the projected map points.
    bool byGuidedMatches()
    {
        double moved = CONVERGED;
        for (int round = 0; round < GUIDED_ROUNDS && !(moved < CONVERGED); round++)
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
        return 3 * std::sqrt(variances[0]) <= MAX_UNCERTAINTY * depth();
    }

    void writeResult() const
    {
        location_.found = true;
        location_.reason = "";
        location_.inliers = keypointsOf(inliers_);
        location_.cameraFromWorld = frame_.toWorld(pose_);
        location_.covariance = OF_CENTRE * frame_.toWorld(covariance_);
        for (int r = 3; r < 6; r++)  // cross terms stay: the rest is independent of the centre
            for (int c = 3; c < 6; c++)
                location_.covariance(r, c) *= OF_ROTATION / OF_CENTRE;
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

    //! Whether random matches would hardly agree as well, counted in matches and in places.
    bool isSignificant() const
    {
        const int sampleSize = 4;
        const std::vector<Point2d> mapped = lens_.project(inCamera(matches_, pose_));
        const auto errorOf = [&](int pixel, int point) {
            const Match& match = matches_[size_t(pixel)];
            const double error = norm(match.errorProjection * (mapped[size_t(point)] - match.pixel));
            return std::isnan(error) ? std::numeric_limits<double>::infinity() : error * error;
        };
        Points pixels;
        std::vector<double> squared;
        for (const Match& m : matches_)
        {
            squared.push_back(errorOf(int(pixels.size()), int(pixels.size())));
            pixels.push_back(m.pixel);
        }
        const Verdict verdict(pixels, pixels);
        return verdict.logFalseAlarms(squared, errorsOfWrongMatches(verdict, errorOf), Verdict::FROM_POINT,
                       sampleSize, {limit_}) < Verdict::CERTAIN;
    }

    double depth() const { return medianDistance(inCamera(inliers_, pose_)); }

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
    std::vector<Match> all_, matches_;   //!< with and without repeated ones
    std::vector<Match> inliers_, used_;  //!< used_: that the pose was refined by
    Affine3d pose_;
    Matx66d covariance_;
};

}  // namespace

int countInliers(const std::vector<Match>& all, const Camera& camera)
{
    std::vector<Match> matches = withoutRepeated(all);
    const Frame frame(matches);
    for (Match& m : matches)
        m.point = frame.toLocal(m.point);
    const Lens lens(camera);
    Affine3d pose;
    if (!poseByRansac(mostSimilar(matches), lens, limitOf(camera), pose))
        return 0;
    return keypointsOf(within(limitOf(camera), matches, lens, pose));
}

void findPose(
        const std::vector<Match>& matches, const Map& map, PreparedPictures& pictures, LocatedImage& found)
{
    PoseSearch search(matches, map, pictures, found);
    if (search.byKeypoints() && search.byGuidedMatches() && search.byLines() && search.isCertain())
        search.writeResult();
}

}  // namespace cv::iib
