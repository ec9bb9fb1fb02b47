// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "match_refiner.hpp"

#include "../common/geometry.hpp"
#include "../common/image_input.hpp"

namespace cv { namespace iib {

namespace {

const double LARGEST_SPACING = 1.25;  //!< pixels from one sample to the next
const double SAME_SIZE = 1.1;
const int SAME_ROTATION = 10;              //!< degrees: smaller rotations need no start place of their own
const size_t VOTING_MATCHES = 64;          //!< for the rotation; every two of them vote
const double LEAST_START_SIMILARITY = .4;  //!< of guided matches, most of which are wrong and end here
const double MATCHES_OF_A_THREAD = 8;

bool hasAngle(const KeyPoint& keypoint) { return keypoint.angle >= 0; }

}  // namespace

//! The arguments of PatchAligner for a match.
struct MatchRefiner::Start
{
    double unit, least;
    PatchPlaces places;

    //! @param ratio scale from the first image to the second. Samples are at most LARGEST_SPACING apart in the second.
    Start(double ratio, double leastSimilarity)
        : unit(std::min(1., LARGEST_SPACING / ratio)), least(leastSimilarity)
    {
    }
};

MatchRefiner::MatchRefiner(const PreparedImage& image1, const PreparedImage& image2,
        const std::vector<KeyPoint>& keypoints1, const std::vector<KeyPoint>& keypoints2,
        const std::vector<DMatch>& matches)
    : first(keypoints1), second(keypoints2), images{image1, image2}
{
    checkKeyPoints(first, true);
    checkKeyPoints(second, true);
    for (const DMatch& match : matches)
    {
        positionOf(first, match.queryIdx, 1);
        positionOf(second, match.trainIdx, 2);
    }
    rotation = rotationOf(matches);
}

//! Whole degrees; 0 without votes.
int MatchRefiner::rotationOf(const std::vector<DMatch>& matches) const
{
    std::vector<const DMatch*> voting;
    for (const DMatch& match : matches)
        if (!hasAngle(first[match.queryIdx]) && !hasAngle(second[match.trainIdx]) &&
                containsFirst(match.queryIdx) && containsSecond(match.trainIdx))
            voting.push_back(&match);
    RotationVotes votes;
    const size_t n = std::min(voting.size(), VOTING_MATCHES);
    for (size_t i = 0; i < n; i++)
        for (size_t j = 0; j < i; j++)
        {
            const DMatch &a = *voting[i * voting.size() / n], &b = *voting[j * voting.size() / n];
            const Point2f from = first[b.queryIdx].pt - first[a.queryIdx].pt;
            const Point2f to = second[b.trainIdx].pt - second[a.trainIdx].pt;
            if (from != Point2f() && to != Point2f())
                votes.add(fastAtan2((float)from.cross(to), (float)from.ddot(to)));
        }
    return std::max(cvRound(votes.peak()), 0);
}

//! Sizes of keypoints err by more than a tenth, so equal sizes are a start place as well.
MatchRefiner::Start MatchRefiner::begin(const Refinement& refinement) const
{
    const KeyPoint &a = first[refinement.match.queryIdx], &b = second[refinement.match.trainIdx];
    const Vec2d place(b.pt.x, b.pt.y);
    if (refinement.guided)
    {
        Start start(std::sqrt(std::abs(determinant(refinement.warp))), LEAST_START_SIMILARITY);
        start.places.add({place, refinement.warp * start.unit});
        return start;
    }
    const double ratio = (double)b.size / a.size;
    Start start(ratio, 0);
    const auto addRotated = [&](float degrees) {
        const Rotation angle(degrees);
        const auto add = [&](double scale) {
            const double c = scale * start.unit * angle.cosine, s = scale * start.unit * angle.sine;
            start.places.add({place, Matx22d(c, -s, s, c)});
        };
        add(ratio);
        if (std::max(ratio, 1 / ratio) >= SAME_SIZE)
            add(1);
    };
    addRotated(hasAngle(a) || hasAngle(b) ? std::max(b.angle, 0.f) - std::max(a.angle, 0.f) : 0);
    if (!hasAngle(a) && !hasAngle(b) && std::min(rotation, 360 - rotation) >= SAME_ROTATION)
        addRotated((float)rotation);
    return start;
}

bool MatchRefiner::isInside(const KeyPoint& keypoint, const Mat& image)
{
    const Point2f p = keypoint.pt;
    return p.x >= 0 && p.y >= 0 && p.x <= image.cols - 1 && p.y <= image.rows - 1;
}

bool MatchRefiner::mayMatch(int query, int train, const Matx22d& warp) const
{
    const Point2f a = first[query].pt, b = second[train].pt;
    return roughlyAgree(images[0].pixels, Vec2d(a.x, a.y), images[1].pixels, Vec2d(b.x, b.y), warp);
}

void MatchRefiner::refine(std::vector<Refinement>& matches) const
{
    parallel_for_(
            Range(0, (int)matches.size()),
            [&](const Range& range) {
                PatchAligner aligner;
                int last = -1;  // matches of one keypoint follow each other and share its template
                double unit = 0;
                for (int i = range.start; i < range.end; i++)
                {
                    Refinement& r = matches[i];
                    const int query = r.match.queryIdx;
                    const Start start = begin(r);
                    r.found = {false, start.places.begin()->centre, -1, Matx22d::eye(), Matx22d::eye()};
                    if (!containsFirst(query) || !containsSecond(r.match.trainIdx))
                        continue;
                    if (query != last || start.unit != unit)
                        aligner.setTemplate(
                                images[0].pixels, Vec2d(first[query].pt.x, first[query].pt.y), start.unit);
                    last = query;
                    unit = start.unit;
                    r.found = aligner.align(images[1].pixels, start.places, start.least);
                }
            },
            matches.size() / MATCHES_OF_A_THREAD);
}

}}  // namespace cv::iib
