// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "../support/test_errors.hpp"
#include "refinement_scene.hpp"

#include "opencv2/imgproc.hpp"

namespace opencv_test {
namespace {

const RefinementScene& scene() { return RefinementScene::seven(); }

//! Of the scene's matches in other images.
Refined refineIn(const Mat& image1, const Mat& image2)
{
    return refine(image1, scene().keypoints[0], image2, scene().keypoints[1], scene().matches);
}

//! How many of the refined points are within a quarter of a pixel of the truth, of those that should be.
double rightShare(const Refined& r, const Matx22d& linear, const Vec2d& shift)
{
    int right = 0;
    for (int i = 0; i < r.points2.rows; i++)
    {
        const Vec2d truth = linear * Vec2d(r.points1.at<float>(i, 0), r.points1.at<float>(i, 1)) + shift;
        const Vec2d found(r.points2.at<float>(i, 0), r.points2.at<float>(i, 1));
        right += r.similarities.at<float>(i) > 0 && cv::norm(found - truth) < .25;
    }
    return right / (double)r.points2.rows;
}
TEST(IIB_Refinement, has_the_documented_types_and_keeps_the_first_points)
{
    const Refined r = refine(scene());
    const int n = (int)scene().matches.size();
    ASSERT_GT(n, 100);
    EXPECT_EQ(Size(2, n), r.points1.size());
    EXPECT_EQ(Size(2, n), r.points2.size());
    EXPECT_EQ(Size(3, n), r.covariances.size());
    EXPECT_EQ(Size(1, n), r.similarities.size());
    for (const Mat& m : {r.points1, r.points2, r.covariances, r.similarities})
        EXPECT_EQ(CV_32F, m.type());
    for (int i = 0; i < n; i++)
        EXPECT_EQ(scene().keypoints[0][i].pt, r.points1.at<Point2f>(i));
    EXPECT_GT(rightShare(r, scene().linear, scene().shift), .95);
}

TEST(IIB_Refinement, is_the_same_for_every_number_of_threads_and_alone)
{
    const int before = getNumThreads();
    setNumThreads(1);
    const Refined expected = refine(scene());
    for (int threads : {2, 5})
    {
        setNumThreads(threads);
        expectSame(expected, refine(scene()));
    }
    setNumThreads(before);
    for (int i : {0, 17})
    {
        const Refined alone = refine(scene().images[0], scene().keypoints[0], scene().images[1],
                scene().keypoints[1], {scene().matches[i]});
        EXPECT_EQ(expected.points2.at<Point2f>(i), alone.points2.at<Point2f>(0));
    }
}

TEST(IIB_Refinement, takes_all_types_of_images)
{
    const Refined expected = refine(scene());
    Mat colours[2], floats[2], sixteen[2];
    for (int i = 0; i < 2; i++)
    {
        cvtColor(scene().images[i], colours[i], COLOR_GRAY2BGRA);
        scene().images[i].convertTo(floats[i], CV_32F, 3, -70);
        scene().images[i].convertTo(sixteen[i], CV_16U, 200);
    }
    expectSame(expected, refineIn(colours[0], colours[1]));
    EXPECT_LT(cvtest::norm(expected.points2, refineIn(floats[0], sixteen[1]).points2, NORM_INF), 2);
    EXPECT_GT(rightShare(refineIn(floats[0], sixteen[1]), scene().linear, scene().shift), .95);
}

TEST(IIB_Refinement, starts_with_the_difference_of_angles)
{
    Mat turned;
    cv::rotate(scene().images[1], turned, ROTATE_90_CLOCKWISE);
    std::vector<KeyPoint> first = scene().keypoints[0], second = scene().keypoints[1];
    for (KeyPoint& kp : second)
    {
        kp.pt = Point2f(turned.cols - 1 - kp.pt.y, kp.pt.x);
        kp.angle = 130;
    }
    const Matx22d quarter(0, -1, 1, 0);
    const Matx22d linear = quarter * scene().linear;
    const Vec2d shift = quarter * scene().shift + Vec2d(turned.cols - 1, 0);
    EXPECT_LT(
            rightShare(refine(scene().images[0], first, turned, second, scene().matches), linear, shift), .1);
    for (KeyPoint& kp : first)
        kp.angle = 40;
    EXPECT_GT(rightShare(refine(scene().images[0], first, turned, second, scene().matches), linear, shift),
            .95);
}

TEST(IIB_Refinement, starts_with_the_ratio_of_sizes)
{
    for (double scale : {.5, .7})
    {
        Mat smaller;
        resize(scene().images[1], smaller, Size(), scale, scale, INTER_AREA);
        std::vector<KeyPoint> first = scene().keypoints[0], second = scene().keypoints[1];
        for (KeyPoint& kp : second)
        {
            kp.pt = (kp.pt + Point2f(.5f, .5f)) * scale - Point2f(.5f, .5f);
            kp.size *= (float)scale;
        }
        const Vec2d half(.5, .5);
        const Matx22d linear = scene().linear * scale;
        const Vec2d shift = (scene().shift + half) * scale - half;
        EXPECT_GT(
                rightShare(refine(scene().images[0], first, smaller, second, scene().matches), linear, shift),
                .9)
                << scale;
        // and from the smaller image to the larger one
        const Matx22d back = linear.inv();
        EXPECT_GT(rightShare(refine(smaller, second, scene().images[0], first, scene().matches), back,
                          back * shift * -1.),
                .7)
                << scale;
    }
}

TEST(IIB_Refinement, refuses_what_does_not_agree_and_leaves_it)
{
    const RefinementScene other(8);
    const Mat flat(scene().images[1].size(), CV_8U, Scalar(90));
    const Refined foreign = refineIn(scene().images[0], other.images[1]),
                  none = refineIn(scene().images[0], flat);
    int refused = 0;
    for (int i = 0; i < none.points2.rows; i++)
    {
        EXPECT_EQ(scene().keypoints[1][i].pt, none.points2.at<Point2f>(i));
        EXPECT_EQ(-1, none.similarities.at<float>(i));
        EXPECT_EQ(Point3f(1, 0, 1), none.covariances.at<Point3f>(i));
        refused += foreign.similarities.at<float>(i) < 0;
    }
    EXPECT_GT(refused, .8 * none.points2.rows);
}

TEST(IIB_Refinement, takes_points_anywhere)
{
    const std::vector<KeyPoint> places = {KeyPoint(0, 0, 9), KeyPoint(639, 479, 9), KeyPoint(-5, 3, 9),
            KeyPoint(1e30f, 2, 9), KeyPoint(320, -1e30f, 1e-30f), KeyPoint(300, 200, 1e30f),
            KeyPoint(5, 300, 9, 77)};
    std::vector<DMatch> matches;
    for (int i = 0; i < (int)places.size(); i++)
        for (int j = 0; j < (int)places.size(); j++)
            matches.push_back(DMatch(i, j, 0));
    const Refined r = refine(scene().images[0], places, scene().images[0], places, matches);
    for (size_t i = 0; i < matches.size(); i++)
        EXPECT_LE(cv::norm(r.points2.at<Point2f>((int)i) - places[matches[i].trainIdx].pt),
                r.similarities.at<float>((int)i) < 0 ? 0 : 1e30);
    const Mat pixel(1, 1, CV_8U, Scalar(7));
    EXPECT_EQ(-1, refine(pixel, {KeyPoint(0, 0, 5)}, pixel, {KeyPoint(0, 0, 5)}, {DMatch(0, 0, 0)})
                          .similarities.at<float>(0));
}

TEST(IIB_Refinement, without_matches_all_is_empty)
{
    const Refined r = refine(Mat(), {}, Mat(), {}, {});
    for (const Mat& m : {r.points1, r.points2, r.covariances, r.similarities})
        EXPECT_TRUE(m.empty());
}

TEST(IIB_Refinement, errors_say_what_is_wrong)
{
    const Mat image = scene().images[0];
    const std::vector<KeyPoint> keypoints = {KeyPoint(50, 50, 9)};
    const std::vector<DMatch> match = {DMatch(0, 0, 0)};
    const auto call = [&](const Mat& a, const Mat& b, const std::vector<KeyPoint>& points, const DMatch& m) {
        return [=] { refine(a, keypoints, b, points, {m}); };
    };
    expectError(Error::StsOutOfRange, "a match is of keypoint 1 of image 2, which has 1",
            call(image, image, keypoints, DMatch(0, 1, 0)));
    expectError(Error::StsOutOfRange, "a match is of keypoint -1 of image 1",
            call(image, image, keypoints, DMatch(-1, 0, 0)));
    expectError(Error::StsBadArg, "image 2 is empty", call(image, Mat(), keypoints, match[0]));
    expectError(Error::StsUnsupportedFormat, "convert it to 8U",
            call(Mat(image.size(), CV_64F, Scalar(0)), image, keypoints, match[0]));
    expectError(Error::StsBadArg, "the image has 2 dimensions and 2 channels",
            call(image, Mat(image.size(), CV_8UC2, Scalar(0)), keypoints, match[0]));
    Mat notANumber(image.size(), CV_32F, Scalar(0));
    notANumber.at<float>(3, 4) = NOT_A_NUMBER;
    expectError(Error::StsBadArg, "NaN or infinite at (4, 3)", call(notANumber, image, keypoints, match[0]));
    expectError(Error::StsBadArg, "must be finite and the size positive",
            call(image, image, {KeyPoint(NOT_A_NUMBER, 3, 9)}, match[0]));
    expectError(Error::StsBadArg, "must be finite and the size positive",
            call(image, image, {KeyPoint(3, 3, 0)}, match[0]));
}

}  // namespace
}  // namespace opencv_test
