// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "votes.hpp"

#include "opencv2/iib/rotation.hpp"

namespace cv {
namespace iib {

namespace {

static constexpr int MAX_VOTES = 200000;  //!< more pairs of matches would not change the result

//! Degrees from 0 to 360.
double directionOf(Point2d v)
{
    const double degrees = std::atan2(v.y, v.x) * 180 / CV_PI;
    return degrees < 0 ? degrees + 360 : degrees;
}

// The position of a keypoint that a match refers to.
Point2d positionOf(const KeyPoint& kp, int index)
{
    if (!(std::abs(kp.pt.x) <= FLT_MAX && std::abs(kp.pt.y) <= FLT_MAX))
        CV_Error(Error::StsBadArg,
                format("keypoint %d is at (%g, %g); positions must be finite", index, kp.pt.x, kp.pt.y));
    return kp.pt;
}

}  // namespace

double estimateRotation(const std::vector<KeyPoint>& keypoints1, const std::vector<KeyPoint>& keypoints2,
        const std::vector<DMatch>& matches)
{
    std::vector<Point2d> from, to;
    for (const DMatch& m : matches)
    {
        if (m.queryIdx < 0 || (size_t)m.queryIdx >= keypoints1.size() || m.trainIdx < 0 ||
                (size_t)m.trainIdx >= keypoints2.size())
            CV_Error(Error::StsOutOfRange,
                    format("a match is of keypoints %d and %d; there are %d and %d", m.queryIdx, m.trainIdx,
                            (int)keypoints1.size(), (int)keypoints2.size()));
        from.push_back(positionOf(keypoints1[m.queryIdx], m.queryIdx));
        to.push_back(positionOf(keypoints2[m.trainIdx], m.trainIdx));
    }
    const size_t n = from.size();
    const size_t offsets = n < 2 ? 0 : std::min(n - 1, std::max(MAX_VOTES / n, (size_t)1));
    RotationVotes votes;
    for (size_t k = 1; k <= offsets; k++)
    {
        const size_t offset = k * (n - 1) / offsets;
        for (size_t i = 0; i < n; i++)
        {
            const size_t j = (i + offset) % n;
            const Point2d before = from[j] - from[i], after = to[j] - to[i];
            if (before == Point2d() || after == Point2d())
                continue;
            const double angle = directionOf(after) - directionOf(before);
            votes.add(angle < 0 ? angle + 360 : angle);
        }
    }
    if (votes.empty())
        CV_Error(Error::StsBadArg, format("%d matches; a rotation needs two whose positions differ", (int)n));
    return votes.peak();
}

}  // namespace iib
}  // namespace cv
