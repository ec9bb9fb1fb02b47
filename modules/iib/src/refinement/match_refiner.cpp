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

Mat checked(InputArray image, int number)
{
    const Mat pixels = image.getMat();
    if (pixels.empty())
        CV_Error(Error::StsBadArg,
                format("image %d is empty, but there are matches: did imread find the file?", number));
    checkImage(pixels);
    return pixels;
}

void checkIndex(const std::vector<KeyPoint>& keypoints, int index, int image)
{
    if (index < 0 || (size_t)index >= keypoints.size())
        CV_Error(Error::StsOutOfRange, format("a match is of keypoint %d of image %d, which has %d", index,
                                               image, (int)keypoints.size()));
}

}  // namespace

//! Where a match begins: what PatchAligner asks for.
struct MatchRefiner::Start
{
    double unit, limit, least;
    PatchPlaces places;

    /* Neighbouring samples are farther apart than a pixel only if that is by little, in the second image of a pair of
     about the same size. */
    Start(double ratio, double leastSimilarity)
        : unit(std::min(1., LARGEST_SPACING / ratio)), limit(LARGEST_MOVE * std::max(ratio, 1.)),
          least(leastSimilarity)
    {
    }
};

MatchRefiner::MatchRefiner(InputArray image1, const std::vector<KeyPoint>& keypoints1, InputArray image2,
        const std::vector<KeyPoint>& keypoints2, const std::vector<DMatch>& matches)
    : first(keypoints1), second(keypoints2)
{
    const Mat images[] = {checked(image1, 1), checked(image2, 2)};
    checkKeyPoints(first, true);
    checkKeyPoints(second, true);
    for (const DMatch& match : matches)
    {
        checkIndex(first, match.queryIdx, 1);
        checkIndex(second, match.trainIdx, 2);
    }
    const auto prepare = [&](const Range& range) {
        for (int i = range.start; i < range.end; i++)
            prepared[i] = preparedForAlignment(normalizeLocally(integerMap(images[i]), NORMALIZATION_SIGMA));
    };
    if (getNumThreads() > 2)
        prepare(Range(0, 2));  // each by all threads
    else
        parallel_for_(Range(0, 2), prepare);
}

//! Sizes of keypoints err by more than a tenth, so that patches may also be of the same size.
MatchRefiner::Start MatchRefiner::begin(const Refinement& refinement) const
{
    const KeyPoint &a = first[refinement.match.queryIdx], &b = second[refinement.match.trainIdx];
    const Vec2d place(b.pt.x, b.pt.y);
    if (refinement.guided)
    {
        Start start(std::sqrt(std::abs(determinant(refinement.map))), LEAST_WITH_MAP);
        start.places.add({place, refinement.map * start.unit});
        return start;
    }
    const double ratio = (double)b.size / a.size;
    Start start(ratio, 0);
    const bool rotated = a.angle >= 0 && b.angle >= 0;
    const Rotation rotation(rotated ? b.angle - a.angle : 0);
    const auto add = [&](double scale) {
        const double c = scale * start.unit * rotation.cosine, s = scale * start.unit * rotation.sine;
        start.places.add({place, Matx22d(c, -s, s, c)});
    };
    add(ratio);
    if (std::max(ratio, 1 / ratio) >= SAME_SIZE)
        add(1);
    return start;
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
                    const Start start = begin(r);
                    r.found = {false, start.places.begin()->centre, -1, Matx22d::eye(), Matx22d::eye()};
                    if (!seesFirst(query) || !seesSecond(r.match.trainIdx))
                        continue;
                    if (query != taken || start.unit != unit)
                        aligner.take(prepared[0], Vec2d(first[query].pt.x, first[query].pt.y), start.unit);
                    taken = query;
                    unit = start.unit;
                    r.found = aligner.align(prepared[1], start.places, start.limit, start.least);
                }
            },
            matches.size() / MATCHES_OF_A_THREAD);
}

}  // namespace iib
}  // namespace cv
