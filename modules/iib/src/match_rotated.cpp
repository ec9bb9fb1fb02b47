// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "precomp.hpp"

#include "opencv2/iib/matcher.hpp"
#include "opencv2/iib/rotation.hpp"

namespace cv {
namespace iib {

namespace {

enum
{
    TRIED_POINTS = 150,  //!< of each image, the strongest
    TRIED_ANGLES = 12    //!< bits bear half of the step between them
};

const float UPRIGHT = -1, STEP = 360.f / TRIED_ANGLES;
const double UPRIGHT_WITHIN = 3;  //!< degrees that upright regions bear

struct Described
{
    std::vector<KeyPoint> keypoints;
    Mat codes;
};

std::vector<KeyPoint> strongest(std::vector<KeyPoint> keypoints)
{
    const auto strength = [](const KeyPoint& kp) { return cvIsNaN(kp.response) ? -FLT_MAX : kp.response; };
    std::stable_sort(keypoints.begin(), keypoints.end(),
            [&](const KeyPoint& a, const KeyPoint& b) { return strength(a) > strength(b); });
    keypoints.resize(std::min(keypoints.size(), (size_t)TRIED_POINTS));
    return keypoints;
}

void setAngle(std::vector<KeyPoint>& keypoints, float angle)
{
    for (KeyPoint& kp : keypoints)
        kp.angle = angle;
}

//! The keypoints at each of the angles, one angle after the other.
Described describe(IIBDescriptorExtractor& extractor, const Mat& image, std::vector<KeyPoint> keypoints,
        const std::vector<float>& angles)
{
    Described all;
    for (float angle : angles)
    {
        setAngle(keypoints, angle);
        all.keypoints.insert(all.keypoints.end(), keypoints.begin(), keypoints.end());
    }
    extractor.compute(image, all.keypoints, all.codes);
    return all;
}

Described atAngle(const Described& all, float angle)
{
    const auto has = [angle](const KeyPoint& kp) { return kp.angle == angle; };
    const auto begin = std::find_if(all.keypoints.begin(), all.keypoints.end(), has);
    const auto end = std::find_if_not(begin, all.keypoints.end(), has);
    const int first = (int)(begin - all.keypoints.begin()), last = (int)(end - all.keypoints.begin());
    return {std::vector<KeyPoint>(begin, end), first == last ? Mat() : all.codes.rowRange(first, last)};
}

std::vector<DMatch> match(const DescriptorMatcher& matcher, const Mat& codes1, const Mat& codes2)
{
    std::vector<DMatch> matches;
    if (!codes1.empty() && !codes2.empty())
        matcher.match(codes1, codes2, matches);
    return matches;
}

//! Pairs of matches between which the direction turns by `angle`, within half a step.
int agreement(
        const Described& first, const Described& second, const std::vector<DMatch>& matches, float angle)
{
    const double radians = angle * CV_PI / 180, within = std::cos(STEP / 2 * CV_PI / 180);
    const Point2d axis(std::cos(radians), std::sin(radians));
    int pairs = 0;
    for (size_t i = 0; i < matches.size(); i++)
        for (size_t j = 0; j < i; j++)
        {
            const Point2d v =
                    first.keypoints[matches[i].queryIdx].pt - first.keypoints[matches[j].queryIdx].pt;
            const Point2d to =
                    second.keypoints[matches[i].trainIdx].pt - second.keypoints[matches[j].trainIdx].pt;
            const Point2d from(v.x * axis.x - v.y * axis.y, v.x * axis.y + v.y * axis.x);
            const double lengths = std::sqrt(from.dot(from) * to.dot(to));
            pairs += lengths > 0 && from.dot(to) >= within * lengths;
        }
    return pairs;
}

//! Degrees; 0 if there is no agreement at any angle.
double findRotation(IIBDescriptorExtractor& extractor, const Mat& image1,
        const std::vector<KeyPoint>& keypoints1, const Mat& image2, const std::vector<KeyPoint>& keypoints2)
{
    // Without a ratio: so few matches and so many angles need none, since wrong matches do not agree.
    const Ptr<HierarchicalMatcher> mutual = HierarchicalMatcher::create();
    mutual->setCrossCheck(true);
    std::vector<float> angles(1, UPRIGHT);
    for (int i = 1; i < TRIED_ANGLES; i++)
        angles.push_back(i * STEP);
    const Described first = describe(extractor, image1, strongest(keypoints1), {UPRIGHT});
    const Described all = describe(extractor, image2, strongest(keypoints2), angles);
    int most = 0;
    Described best;
    std::vector<DMatch> bestMatches;
    for (float angle : angles)
    {
        const Described second = atAngle(all, angle);
        const std::vector<DMatch> matches = match(*mutual, first.codes, second.codes);
        const int agree = agreement(first, second, matches, std::max(angle, 0.f));
        if (agree > most)
        {
            most = agree;
            best = second;
            bestMatches = matches;
        }
    }
    return most ? estimateRotation(first.keypoints, best.keypoints, bestMatches) : 0;
}

}  // namespace

double matchRotated(InputArray image1, std::vector<KeyPoint>& keypoints1, InputArray image2,
        std::vector<KeyPoint>& keypoints2, const Ptr<IIBDescriptorExtractor>& extractor,
        const Ptr<DescriptorMatcher>& matcher, std::vector<DMatch>& matches1to2, double rotation)
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
    const Mat images[] = {image1.getMat(), image2.getMat()};
    if (rotation < 0)
        rotation = images[0].empty() || images[1].empty()
                           ? 0
                           : findRotation(*extractor, images[0], keypoints1, images[1], keypoints2);
    const bool upright = std::min(rotation, 360 - rotation) <= UPRIGHT_WITHIN;
    setAngle(keypoints1, UPRIGHT);
    setAngle(keypoints2, upright ? UPRIGHT : (float)rotation);
    Mat codes[2];
    extractor->compute(images[0], keypoints1, codes[0]);
    extractor->compute(images[1], keypoints2, codes[1]);
    matches1to2 = match(*matcher, codes[0], codes[1]);
    return rotation;
}

double matchRotated(InputArray image1, InputArray image2, const Ptr<IIBDescriptorExtractor>& extractor,
        const Ptr<DescriptorMatcher>& matcher, std::vector<KeyPoint>& keypoints1,
        std::vector<KeyPoint>& keypoints2, std::vector<DMatch>& matches1to2, double rotation)
{
    if (!extractor)
        CV_Error(Error::StsNullPtr, "there is no extractor");
    extractor->detect(image1, keypoints1);
    extractor->detect(image2, keypoints2);
    return matchRotated(image1, keypoints1, image2, keypoints2, extractor, matcher, matches1to2, rotation);
}

}  // namespace iib
}  // namespace cv
