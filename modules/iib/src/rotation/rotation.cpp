// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "../common/geometry.hpp"
#include "../common/image_input.hpp"

#include "opencv2/iib/matcher.hpp"
#include "opencv2/iib/rotation.hpp"
#include "opencv2/imgproc.hpp"

namespace cv { namespace iib {

namespace {

static constexpr int MAX_VOTES = 200000;  //!< more pairs of matches would not change estimateRotation()
static constexpr int TRIED_POINTS = 200;  //!< of each image, the strongest
static constexpr float UPRIGHT = -1;
static constexpr double UPRIGHT_WITHIN = 3;  //!< degrees; upright regions match at smaller rotations
// Differences of a second and a first angle give every multiple of 30 degrees; descriptors match up to 15 degrees off.
const float FIRST_ANGLES[] = {UPRIGHT, 30, 60}, SECOND_ANGLES[] = {UPRIGHT, 90, 180, 270};
static constexpr float ANGLE_TOLERANCE = 18;      //!< degrees
static constexpr double LENGTH_TOLERANCE = 1.25;  //!< ratio, since distances from the camera differ

struct Described
{
    std::vector<KeyPoint> keypoints;
    Mat codes;
};

void setAngle(std::vector<KeyPoint>& keypoints, float angle)
{
    for (KeyPoint& kp : keypoints)
        kp.angle = angle;
}

//! Describes the strongest keypoints at each angle, at half the image's resolution to save time.
template <size_t N>
std::vector<Described> describeHalf(IIBDescriptorExtractor& extractor, const Mat& image,
        std::vector<KeyPoint> keypoints, const float (&angles)[N])
{
    if (image.empty())
        return {};
    checkImage(image);
    checkKeyPoints(keypoints, false);
    const auto strength = [](const KeyPoint& kp) { return cvIsNaN(kp.response) ? -FLT_MAX : kp.response; };
    std::stable_sort(keypoints.begin(), keypoints.end(),
            [&](const KeyPoint& a, const KeyPoint& b) { return strength(a) > strength(b); });
    keypoints.resize(std::min(keypoints.size(), (size_t)TRIED_POINTS));
    Mat half;
    resize(image, half, Size(std::max(image.cols / 2, 1), std::max(image.rows / 2, 1)), 0, 0, INTER_AREA);
    for (KeyPoint& kp : keypoints)
    {
        kp.pt = (kp.pt + Point2f(0.5f, 0.5f)) / 2 - Point2f(0.5f, 0.5f);
        kp.size = std::max(kp.size / 2, FLT_MIN);  // not 0
    }
    std::vector<KeyPoint> all;
    for (float angle : angles)
    {
        setAngle(keypoints, angle);
        all.insert(all.end(), keypoints.begin(), keypoints.end());
    }
    Mat codes;
    extractor.compute(half, all, codes);
    std::vector<Described> described;
    for (int i = 0, end = 0; i < (int)N; i++)
    {
        // under BORDER_DROP, some may be missing
        const int begin = end;
        while (end < (int)all.size() && all[end].angle == angles[i])
            end++;
        described.push_back({{all.begin() + begin, all.begin() + end},
                begin == end ? Mat() : codes.rowRange(begin, end)});
    }
    return described;
}

std::vector<DMatch> match(const DescriptorMatcher& matcher, const Mat& codes1, const Mat& codes2)
{
    std::vector<DMatch> matches;
    if (!codes1.empty() && !codes2.empty())
        matcher.match(codes1, codes2, matches);
    return matches;
}

/** Each pair of matches votes for the angle between its directions, if that is near the one that the descriptors were
 rotated by and lengths change as sizes do. */
void vote(const Described& first, const Described& second, const std::vector<DMatch>& matches, float angle,
        RotationVotes& votes)
{
    for (size_t i = 0; i < matches.size(); i++)
        for (size_t j = 0; j < i; j++)
        {
            const KeyPoint &a = first.keypoints[matches[i].queryIdx],
                           &b = first.keypoints[matches[j].queryIdx],
                           &c = second.keypoints[matches[i].trainIdx],
                           &d = second.keypoints[matches[j].trainIdx];
            const Point2f from = b.pt - a.pt, to = d.pt - c.pt;
            const double lengths[] = {from.ddot(from) * c.size * d.size, to.ddot(to) * a.size * b.size};
            const double most = LENGTH_TOLERANCE * LENGTH_TOLERANCE * std::min(lengths[0], lengths[1]);
            if (std::max(lengths[0], lengths[1]) >= most)
                continue;
            const float rotation = fastAtan2((float)from.cross(to), from.dot(to));
            const float error = std::abs(rotation - angle);
            if (std::min(error, 360 - error) <= ANGLE_TOLERANCE)
                votes.add(rotation);
        }
}

//! Degrees; 0 if nothing votes.
double findRotation(IIBDescriptorExtractor& extractor, const Mat& image1,
        const std::vector<KeyPoint>& keypoints1, const Mat& image2, const std::vector<KeyPoint>& keypoints2)
{
    // no ratio test: wrong matches do not agree anyway
    const Ptr<HierarchicalMatcher> mutual = HierarchicalMatcher::create();
    mutual->setCrossCheck(true);
    const std::vector<Described> first = describeHalf(extractor, image1, keypoints1, FIRST_ANGLES);
    const std::vector<Described> second = describeHalf(extractor, image2, keypoints2, SECOND_ANGLES);
    RotationVotes votes;
    for (size_t i = 0; i < first.size(); i++)
        for (size_t j = 0; j < second.size(); j++)
        {
            const float angle = std::max(SECOND_ANGLES[j], 0.f) - std::max(FIRST_ANGLES[i], 0.f);
            vote(first[i], second[j], match(*mutual, first[i].codes, second[j].codes),
                    angle < 0 ? angle + 360 : angle, votes);
        }
    return std::max(votes.peak(), 0.);
}

void checkArguments(
        const Ptr<IIBDescriptorExtractor>& extractor, const Ptr<DescriptorMatcher>& matcher, double rotation)
{
    if (!extractor || !matcher)
        CV_Error(Error::StsNullPtr, "there is no " + String(extractor ? "matcher" : "extractor"));
    if (extractor->getOrientation() != IIBDescriptorExtractor::ORIENTATION_KEYPOINT)
        CV_Error(Error::StsBadArg,
                format("the extractor's orientation is %d; call setOrientation(ORIENTATION_KEYPOINT), which "
                       "describes keypoints of angle -1 upright as before",
                        extractor->getOrientation()));
    if (!(rotation == -1 || (rotation >= 0 && rotation < 360)))
        CV_Error(Error::StsOutOfRange,
                format("the rotation is %g; it is 0 or more and less than 360 degrees, or -1 to find it",
                        rotation));
}

}  // namespace

double estimateRotation(const std::vector<KeyPoint>& keypoints1, const std::vector<KeyPoint>& keypoints2,
        const std::vector<DMatch>& matches)
{
    std::vector<Point2d> from, to;
    for (const DMatch& m : matches)
    {
        from.push_back(positionOf(keypoints1, m.queryIdx, 1));
        to.push_back(positionOf(keypoints2, m.trainIdx, 2));
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
            const double angle = std::atan2(before.cross(after), before.dot(after)) * 180 / CV_PI;
            votes.add(angle < 0 ? angle + 360 : angle);
        }
    }
    const double angle = votes.peak();
    if (angle < 0)
        CV_Error(Error::StsBadArg,
                format("%d matches: a rotation needs at least two with different positions", (int)n));
    return angle;
}

double matchRotated(InputArray image1, std::vector<KeyPoint>& keypoints1, InputArray image2,
        std::vector<KeyPoint>& keypoints2, const Ptr<IIBDescriptorExtractor>& extractor,
        const Ptr<DescriptorMatcher>& matcher, std::vector<DMatch>& matches1to2, double rotation)
{
    checkArguments(extractor, matcher, rotation);
    const Mat images[] = {image1.getMat(), image2.getMat()};
    if (rotation < 0)
        rotation = findRotation(*extractor, images[0], keypoints1, images[1], keypoints2);
    const bool upright = std::min(rotation, 360 - rotation) <= UPRIGHT_WITHIN;
    // copies, so that an error leaves the caller's keypoints unchanged
    std::vector<KeyPoint> first = keypoints1, second = keypoints2;
    setAngle(first, UPRIGHT);
    setAngle(second, upright ? UPRIGHT : (float)rotation);
    Mat codes[2];
    extractor->compute(images[0], first, codes[0]);
    extractor->compute(images[1], second, codes[1]);
    matches1to2 = match(*matcher, codes[0], codes[1]);
    keypoints1.swap(first);
    keypoints2.swap(second);
    return rotation;
}

double matchRotated(InputArray image1, InputArray image2, const Ptr<IIBDescriptorExtractor>& extractor,
        const Ptr<DescriptorMatcher>& matcher, std::vector<KeyPoint>& keypoints1,
        std::vector<KeyPoint>& keypoints2, std::vector<DMatch>& matches1to2, double rotation)
{
    checkArguments(extractor, matcher, rotation);
    std::vector<KeyPoint> first, second;  // an error leaves the caller's keypoints unchanged
    extractor->detect(image1, first);
    extractor->detect(image2, second);
    rotation = matchRotated(image1, first, image2, second, extractor, matcher, matches1to2, rotation);
    keypoints1.swap(first);
    keypoints2.swap(second);
    return rotation;
}

}}  // namespace cv::iib
