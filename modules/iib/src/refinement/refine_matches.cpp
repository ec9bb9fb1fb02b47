// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "../common/geometry.hpp"
#include "../common/image_input.hpp"
#include "../normalization/local_normalization.hpp"
#include "patch_aligner.hpp"

#include "opencv2/iib/refinement.hpp"

namespace cv {
namespace iib {

namespace {

const double NORMALIZATION_SIGMA = 8;
const double LARGEST_SPACING = 1.25;  //!< pixels from one sample to the next
const double SAME_SIZE = 1.1;
const double LARGEST_MOVE = 2;  //!< in pixels
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

bool isInside(const KeyPoint& keypoint, const Mat& image)
{
    const Point2f p = keypoint.pt;
    return p.x >= 0 && p.y >= 0 && p.x <= image.cols - 1 && p.y <= image.rows - 1;
}

//! Where to begin.
struct Start
{
    double unit, limit;
    std::vector<PatchPlace> places;  //!< in the second image: all that are tried

    /* Sizes of keypoints err by more than a tenth, so that patches may also be of the same size. Neighbouring samples are
     farther apart than a pixel only if that is by little, in the second image of a pair of about the same size. */
    Start(const KeyPoint& a, const KeyPoint& b)
    {
        const double ratio = (double)b.size / a.size;
        const bool rotated = a.angle >= 0 && b.angle >= 0;
        const Rotation rotation(rotated ? b.angle - a.angle : 0);
        unit = std::min(1., LARGEST_SPACING / ratio);
        limit = LARGEST_MOVE * std::max(ratio, 1.);
        for (double scale : {ratio, 1.})
        {
            if (!places.empty() && std::max(ratio, 1 / ratio) < SAME_SIZE)
                break;
            const double c = scale * unit * rotation.cosine, s = scale * unit * rotation.sine;
            places.push_back({Vec2d(b.pt.x, b.pt.y), Matx22d(c, -s, s, c)});
        }
    }
};

}  // namespace

void refineMatches(InputArray image1, const std::vector<KeyPoint>& keypoints1, InputArray image2,
        const std::vector<KeyPoint>& keypoints2, const std::vector<DMatch>& matches1to2, OutputArray points1,
        OutputArray points2, OutputArray covariances, OutputArray similarities)
{
    const int n = (int)matches1to2.size();
    Mat first(n, 2, CV_32F), second(n, 2, CV_32F), covariance(n, 3, CV_32F), similarity(n, 1, CV_32F);
    if (n > 0)
    {
        checkKeyPoints(keypoints1, true);
        checkKeyPoints(keypoints2, true);
        for (const DMatch& match : matches1to2)
        {
            keypointOf(keypoints1, match.queryIdx, 1);
            keypointOf(keypoints2, match.trainIdx, 2);
        }
        const Mat prepared1 = preparedImage(image1, 1), prepared2 = preparedImage(image2, 2);
        parallel_for_(
                Range(0, n),
                [&](const Range& range) {
                    PatchAligner aligner;
                    for (int i = range.start; i < range.end; i++)
                    {
                        const KeyPoint& a = keypoints1[matches1to2[i].queryIdx];
                        const KeyPoint& b = keypoints2[matches1to2[i].trainIdx];
                        PatchAlignment found = {false, Vec2d(b.pt.x, b.pt.y), -1, Matx22d::eye()};
                        if (isInside(a, prepared1) && isInside(b, prepared2))
                        {
                            const Start start(a, b);
                            found = aligner.align(prepared1, Vec2d(a.pt.x, a.pt.y), start.unit, prepared2,
                                    start.places, start.limit);
                        }
                        first.at<Point2f>(i) = a.pt;
                        second.at<Vec2f>(i) = found.point;
                        similarity.at<float>(i) = (float)found.similarity;
                        const Matx22d& c = found.covariance;
                        covariance.at<Vec3f>(i) = Vec3d(c(0, 0), c(0, 1), c(1, 1));
                    }
                },
                n / MATCHES_OF_A_THREAD);
    }
    first.copyTo(points1);
    second.copyTo(points2);
    if (covariances.needed())
        covariance.copyTo(covariances);
    if (similarities.needed())
        similarity.copyTo(similarities);
}

}  // namespace iib
}  // namespace cv
