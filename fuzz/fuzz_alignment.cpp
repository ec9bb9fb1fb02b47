// SPDX-License-Identifier: Apache-2.0

// ImageAligner, alignImages and matchViews with small images of any type, masks and models. Expects a cv::Exception
// exactly for arguments that the header forbids. Otherwise expects a reason, or a transform of the model from matches
// inside the masks.

#include "images.hpp"

#include "opencv2/iib/alignment.hpp"
#include "opencv2/iib/views.hpp"
#include "opencv2/imgproc.hpp"

#include <map>

namespace {

using namespace fuzz;
using namespace cv::iib;

const int SIDE = 128;

//! A picture of patches of a few pixels, different for each seed.
const Mat& texture(int seed)
{
    static std::map<int, Mat> known;
    Mat& picture = known[seed];
    if (picture.empty())
    {
        Mat coarse(SIDE / 4, SIDE / 4, CV_8U);
        RNG(seed + 1).fill(coarse, RNG::UNIFORM, 20, 235);
        resize(coarse, picture, Size(SIDE, SIDE), 0, 0, INTER_CUBIC);
    }
    return picture;
}

//! From pixels of the image to those of the texture; a translation, similarity, affine map or homography.
Matx33d drawTransform(ByteSource& in)
{
    const auto upTo = [&](double most) { return most * in.between(-100, 100) / 100; };
    Matx33d transform(1, 0, upTo(20), 0, 1, upTo(20), 0, 0, 1);
    if (in.flag())
    {
        const double turn = upTo(in.rarely(4) ? CV_PI : .4);
        const Vec2d axis = (1 + upTo(.4)) * Vec2d(std::cos(turn), std::sin(turn));
        transform = transform * Matx33d(axis[0], -axis[1], 0, axis[1], axis[0], 0, 0, 0, 1);
    }
    if (in.flag())
        transform = transform * Matx33d(1 + upTo(.2), upTo(.2), 0, 0, 1, 0, 0, 0, 1);
    return in.flag() ? Matx33d(1, 0, 0, 0, 1, 0, upTo(2e-3), upTo(2e-3), 1) * transform : transform;
}

//! In most runs a transformed picture of the seed, with its own brightness and type; otherwise any image.
Mat drawPicture(ByteSource& in, int seed, const Matx33d& transform)
{
    if (in.rarely(16))
    {
        const Size size = drawSize(in);
        return drawImage(in, size, in.flag());
    }
    const int width = in.between(1, 6) * SIDE / 8;
    const Size size(width, in.between(1, 6) * SIDE / 8);
    Mat image;
    warpPerspective(texture(in.rarely(8) ? seed + 1 : seed), image, transform, size, INTER_LINEAR,
            in.flag() ? BORDER_REFLECT : BORDER_CONSTANT);
    const int depth = drawDepth(in), channels = in.between(1, 4);
    image.convertTo(image, depth, in.between(0, 20) / 10. * (depth == CV_8U ? 1 : 256), in.between(-60, 60));
    merge(std::vector<Mat>((size_t)(channels == 2 ? 1 : channels), image), image);
    return image;
}

//! A mask, empty in half of the runs; otherwise mostly of the image's size.
Mat drawMask(ByteSource& in, const Mat& image)
{
    if (in.flag())
        return Mat();
    Mat mask(in.rarely(16) ? drawSize(in) : image.size(), in.rarely(32) ? CV_16U : CV_8U,
            Scalar(in.between(0, 255)));
    const Rect part(in.between(0, SIDE), in.between(0, SIDE), in.between(1, SIDE), in.between(1, SIDE));
    mask(part & Rect(Point(), mask.size())).setTo(in.between(0, 1));
    return mask;
}

bool isTaken(const Mat& image) { return image.empty() || isImage(image); }

bool fits(const Mat& mask, const Mat& image)
{
    return mask.empty() || (mask.type() == CV_8U && mask.size() == image.size());
}

//! Checks that a point is near a mask; not inside, since refinement moves points and views resample masks.
void checkAllowed(const Mat& mask, const Point2f& point)
{
    const Rect around(Point((int)point.x - 4, (int)point.y - 4), Size(9, 9));
    FUZZ_CHECK(mask.empty() || countNonZero(mask(around & Rect(Point(), mask.size()))) > 0);
}

void checkViews(const Mat& first, const Mat& mask1, const Mat& second, const Mat& mask2, double maxTilt)
{
    Mat points1, points2, covariances, similarities, view;
    String reason;
    bool found = false;
    const bool thrown = refused([&] {
        found = matchViews(first, second, points1, points2, covariances, similarities, view, 300, maxTilt,
                mask1, mask2, &reason);
    });
    FUZZ_CHECK(thrown == !(maxTilt >= 1 && maxTilt <= 8 && isTaken(first) && isTaken(second) &&
                                 fits(mask1, first) && fits(mask2, second)));
    if (thrown)
        return;
    FUZZ_CHECK(found == reason.empty() && found == !view.empty());
    FUZZ_CHECK(points1.size() == points2.size() && points1.rows == covariances.rows &&
               points1.rows == similarities.rows);
    FUZZ_CHECK(view.empty() || (view.size() == Size(3, 3) && view.type() == CV_64F && checkRange(view)));
    for (int i = 0; i < points1.rows; i++)
    {
        const Vec2f p = points1.at<Vec2f>(i), q = points2.at<Vec2f>(i);
        FUZZ_CHECK(std::isfinite(p[0] + p[1] + q[0] + q[1]));
        const Vec3f c = covariances.at<Vec3f>(i);
        FUZZ_CHECK(c[0] > 0 && c[2] > 0 && c[0] * c[2] > c[1] * c[1]);
        checkAllowed(mask1, Point2f(p[0], p[1]));
        checkAllowed(mask2, Point2f(q[0], q[1]));
    }
}

void checkAnswer(const Mat& reference, const Mat& mask, const Mat& image, const Mat& other, int model,
        const Mat& found, const Mat& error, const Mat& matches)
{
    FUZZ_CHECK(found.size() == Size(3, 3) && found.type() == CV_64F && checkRange(found));
    FUZZ_CHECK(error.size() == Size(1, 4) && error.type() == CV_64F && checkRange(error));
    const Matx33d m(found);
    FUZZ_CHECK(std::abs(m(2, 2) - 1) < 1e-12 && determinant(m) != 0);
    // The constraints of the model, up to rounding.
    const double most = 1e-9 * norm(m);
    FUZZ_CHECK(model == ALIGN_HOMOGRAPHY || std::hypot(m(2, 0), m(2, 1)) <= most);
    FUZZ_CHECK(model >= ALIGN_AFFINE || std::hypot(m(0, 0) - m(1, 1), m(0, 1) + m(1, 0)) <= most);
    FUZZ_CHECK(model != ALIGN_TRANSLATION || std::hypot(m(0, 0) - 1, m(0, 1)) <= most);
    for (int k = 0; k < 4; k++)
        FUZZ_CHECK(error.at<double>(k) > 0);
    FUZZ_CHECK(!matches.empty());
    for (int i = 0; i < matches.rows; i++)
    {
        const Vec4f match = matches.at<Vec4f>(i);
        const Rect2f there(Point2f(-3, -3), Size2f(image.size()) + Size2f(6, 6));
        const Point first(
                (int)(match[0] + .5f), (int)(match[1] + .5f));  // rounded as in OpenCV's masking of keypoints
        FUZZ_CHECK(Rect(Point(), reference.size()).contains(first) &&
                   there.contains(Point2f(match[2], match[3])));
        checkAllowed(mask, Point2f(match[0], match[1]));
        checkAllowed(other, Point2f(match[2], match[3]));
    }
}

}  // namespace

FUZZ_TARGET
{
    const int seed = in.between(0, 3), model = in.between(-in.rarely(32), ALIGN_AUTO);
    const Mat reference = drawPicture(in, seed, Matx33d::eye()), mask = drawMask(in, reference);
    if (in.flag())
    {
        const Mat image = drawPicture(in, seed, drawTransform(in)), other = drawMask(in, image);
        return checkViews(
                reference, mask, image, other, in.rarely(32) ? in.between(-1, 10) : in.between(1, 8));
    }
    Ptr<ImageAligner> aligner;
    FUZZ_CHECK(refused([&] { aligner = ImageAligner::create(reference, model, mask); }) ==
               (model < 0 || !fits(mask, reference)));
    for (int images = in.between(1, 2); images > 0 && aligner; images--)
    {
        const Mat image = drawPicture(in, seed, drawTransform(in)), other = drawMask(in, image);
        Mat found, error, matches, again(1, 1, CV_8U);
        String reason;
        bool aligned = false;
        int simplest = -1;
        const bool thrown = refused(
                [&] { aligned = aligner->align(image, found, error, matches, &reason, other, &simplest); });
        FUZZ_CHECK(thrown == !(isTaken(reference) && isTaken(image) && fits(other, image)));
        if (thrown)
            continue;
        FUZZ_CHECK(aligned == reason.empty() &&
                   (matches.empty() || (matches.cols == 4 && matches.type() == CV_32F)));
        FUZZ_CHECK(aligned || (found.empty() && error.empty() && simplest == -1));
        if (aligned)
            checkAnswer(reference, mask, image, other, model == ALIGN_AUTO ? simplest : model, found, error,
                    matches);
        if (mask.empty() && other.empty() && in.rarely(8))
        {
            FUZZ_CHECK(alignImages(reference, image, again, model) == aligned);
            FUZZ_CHECK(again.size() == found.size() && (found.empty() || norm(again, found, NORM_INF) == 0));
        }
    }
}
