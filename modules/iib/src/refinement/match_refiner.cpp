// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "match_refiner.hpp"

#include "../common/geometry.hpp"
#include "../common/image_input.hpp"
#include "../normalization/local_normalization.hpp"

namespace cv {
namespace iib {

namespace {

const double NORMALIZATION_SIGMA = 8;
const double LARGEST_SPACING = 1.25;  //!< pixels from one sample to the next
const double SAME_SIZE = 1.1;
const double LARGEST_MOVE = 2;     //!< in pixels
const double LEAST_WITH_MAP = .3;  //!< similarity at the start: most tries are wrong, and end here
const double MATCHES_OF_A_THREAD = 8;

Mat preparedImage(InputArray image, int number)
{
    const Mat pixels = image.getMat();
    if (pixels.empty())
        CV_Error(Error::StsBadArg,
                format("image %d is empty, but there are matches: did imread find the file?", number));
    checkImage(pixels);
    return preparedForAlignment(normalizeLocally(integerMap(pixels), NORMALIZATION_SIGMA));
}

const KeyPoint& keypointOf(const std::vector<KeyPoint>& keypoints, int index, int image)
{
    if (index < 0 || (size_t)index >= keypoints.size())
        CV_Error(Error::StsOutOfRange, format("a match is of keypoint %d of image %d, which has %d", index,
                                               image, (int)keypoints.size()));
    return keypoints[index];
}

/* Neighbouring samples are farther apart than a pixel only if that is by little, in the second image of a pair of about the
 same size. */
Refinement begun(const DMatch& match, double ratio, double least)
{
    return {match, std::min(1., LARGEST_SPACING / ratio), LARGEST_MOVE * std::max(ratio, 1.), least, {},
            PatchAlignment()};
}

}  // namespace

MatchRefiner::MatchRefiner(InputArray image1, const std::vector<KeyPoint>& keypoints1, InputArray image2,
        const std::vector<KeyPoint>& keypoints2)
    : first(keypoints1), second(keypoints2)
{
    checkKeyPoints(first, true);
    checkKeyPoints(second, true);
    prepared1 = preparedImage(image1, 1);
    prepared2 = preparedImage(image2, 2);
}

//! Sizes of keypoints err by more than a tenth, so that patches may also be of the same size.
Refinement MatchRefiner::begin(const DMatch& match) const
{
    const KeyPoint& a = keypointOf(first, match.queryIdx, 1);
    const KeyPoint& b = keypointOf(second, match.trainIdx, 2);
    const double ratio = (double)b.size / a.size;
    const bool rotated = a.angle >= 0 && b.angle >= 0;
    const Rotation rotation(rotated ? b.angle - a.angle : 0);
    Refinement result = begun(match, ratio, 0);
    for (double scale : {ratio, 1.})
    {
        if (!result.starts.empty() && std::max(ratio, 1 / ratio) < SAME_SIZE)
            break;
        const double c = scale * result.unit * rotation.cosine, s = scale * result.unit * rotation.sine;
        result.starts.push_back({Vec2d(b.pt.x, b.pt.y), Matx22d(c, -s, s, c)});
    }
    return result;
}

Refinement MatchRefiner::begin(const DMatch& match, const Matx22d& map) const
{
    const Point2f p = second[match.trainIdx].pt;
    Refinement result = begun(match, std::sqrt(std::abs(determinant(map))), LEAST_WITH_MAP);
    result.starts.push_back({Vec2d(p.x, p.y), map * result.unit});
    return result;
}

bool MatchRefiner::isInside(const KeyPoint& keypoint, const Mat& image)
{
    const Point2f p = keypoint.pt;
    return p.x >= 0 && p.y >= 0 && p.x <= image.cols - 1 && p.y <= image.rows - 1;
}

void MatchRefiner::refine(std::vector<Refinement>& matches) const
{
    parallel_for_(
            Range(0, (int)matches.size()),
            [&](const Range& range) {
                PatchAligner aligner;
                int taken = -1;  // tries of one keypoint follow each other
                double unit = 0;
                for (int i = range.start; i < range.end; i++)
                {
                    Refinement& r = matches[i];
                    const int query = r.match.queryIdx;
                    r.found = {false, r.starts[0].centre, -1, Matx22d::eye(), Matx22d::eye()};
                    if (!seesFirst(query) || !seesSecond(r.match.trainIdx))
                        continue;
                    if (query != taken || r.unit != unit)
                        aligner.take(prepared1, Vec2d(first[query].pt.x, first[query].pt.y), r.unit);
                    taken = query;
                    unit = r.unit;
                    r.found = aligner.align(prepared2, r.starts, r.limit, r.least);
                }
            },
            matches.size() / MATCHES_OF_A_THREAD);
}

}  // namespace iib
}  // namespace cv
