// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "refinement_scene.hpp"

#include "../support/test_images.hpp"

#include "opencv2/imgproc.hpp"

namespace opencv_test {

namespace {

const int FINE = 4;  //!< a camera's pixel is the mean of FINE x FINE pixels
const Size SIZE(640, 480);

Mat photographed(const Mat& fine)
{
    Mat image;
    resize(fine, image, SIZE, 0, 0, INTER_AREA);
    return image;
}

Mat noisy(const Mat& image, int seed)
{
    RNG rng(seed);
    Mat noise(image.size(), CV_32F), result;
    rng.fill(noise, RNG::NORMAL, 0, 2);
    cv::add(image, noise, result, noArray(), CV_8U);
    return result;
}

}  // namespace

RefinementScene::RefinementScene(int seed)
{
    Mat shapes, grain(SIZE * 2, CV_8U), fine;
    RNG(seed).fill(grain, RNG::UNIFORM, 0, 256);
    resize(scene(SIZE * 2, seed), shapes, SIZE * FINE, 0, 0, INTER_CUBIC);
    resize(grain, grain, SIZE * FINE, 0, 0, INTER_CUBIC);
    // not in place: addWeighted() to another depth would read its own output
    addWeighted(shapes, .3, grain, .6, 0, fine, CV_32F);
    GaussianBlur(fine, fine, Size(), 2);
    images[0] = noisy(photographed(fine), 2 * seed + 1);

    Integers integers(seed);
    const auto upTo = [&](double limit) { return limit * integers.between(-1000, 1001) / 1000; };
    const double angle = upTo(5) * CV_PI / 180, c = std::cos(angle), s = std::sin(angle);
    // braces fix the order in which random arguments are drawn
    linear = Matx22d(c, -s, s, c) * (Matx22d::eye() + Matx22d{upTo(.1), upTo(.1), upTo(.1), upTo(.1)});
    const Vec2d centre(SIZE.width / 2., SIZE.height / 2.);
    shift = centre + Vec2d{upTo(3), upTo(3)} - linear * centre;
    // the same between fine pixels, whose centres are at (x + .5) / FINE - .5
    const Vec2d half((FINE - 1) / 2., (FINE - 1) / 2.), fineShift = shift * FINE + half - linear * half;
    const Matx23d warp(linear(0, 0), linear(0, 1), fineShift[0], linear(1, 0), linear(1, 1), fineShift[1]);
    Mat moved;
    warpAffine(fine, moved, warp, fine.size(), INTER_CUBIC, BORDER_REFLECT);
    Mat lit = photographed(moved);
    for (int y = 0; y < lit.rows; y++)
        for (int x = 0; x < lit.cols; x++)
            lit.at<float>(y, x) = lit.at<float>(y, x) * (.5f + .4f * x / lit.cols) + 15;
    images[1] = noisy(lit, 2 * seed + 2);

    for (KeyPoint keypoint : found(*HessianDetector::create(300), images[0]))
    {
        const Point2f place = truth(keypoint.pt);
        if (!Rect2f(20, 20, SIZE.width - 40, SIZE.height - 40).contains(place))
            continue;
        matches.push_back(DMatch((int)matches.size(), (int)matches.size(), 0));
        keypoints[0].push_back(keypoint);
        keypoint.pt = place + Point2f(Point2d{upTo(.6), upTo(.6)});
        keypoints[1].push_back(keypoint);
    }
}

Point2d RefinementScene::truth(const Point2f& point) const
{
    return Point2d(linear * Vec2d(point.x, point.y) + shift);
}

const RefinementScene& RefinementScene::seven()
{
    static const RefinementScene made(7);
    return made;
}

Refined refine(const Mat& image1, const std::vector<KeyPoint>& keypoints1, const Mat& image2,
        const std::vector<KeyPoint>& keypoints2, const std::vector<DMatch>& matches)
{
    Refined r;
    r.matches = matches;
    refineMatches(image1, keypoints1, image2, keypoints2, matches, r.points1, r.points2, r.covariances,
            r.similarities);
    return r;
}

Refined refine(const RefinementScene& scene)
{
    return refine(scene.images[0], scene.keypoints[0], scene.images[1], scene.keypoints[1], scene.matches);
}

void expectSame(const Refined& expected, const Refined& actual)
{
    const int n = expected.points1.rows;
    ASSERT_LE(n, actual.points1.rows);
    EXPECT_EQ(0, cvtest::norm(expected.points1, actual.points1.rowRange(0, n), NORM_INF));
    EXPECT_EQ(0, cvtest::norm(expected.points2, actual.points2.rowRange(0, n), NORM_INF));
    EXPECT_EQ(0, cvtest::norm(expected.covariances, actual.covariances.rowRange(0, n), NORM_INF));
    EXPECT_EQ(0, cvtest::norm(expected.similarities, actual.similarities.rowRange(0, n), NORM_INF));
}

double inSigmas(const Point2d& error, const Point3d& c)
{
    return std::sqrt((c.z * error.x * error.x - 2 * c.y * error.x * error.y + c.x * error.y * error.y) /
                     (c.x * c.z - c.y * c.y));
}

}  // namespace opencv_test
