// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "../support/test_errors.hpp"
#include "../support/textures.hpp"
#include "refinement_scene.hpp"

#include "opencv2/imgcodecs.hpp"
#include "opencv2/imgproc.hpp"

namespace opencv_test { namespace {

const RefinementScene& scene() { return RefinementScene::seven(); }

//! Refines the scene's matches in other images.
Refined refineIn(const Mat& image1, const Mat& image2)
{
    return refine(image1, scene().keypoints[0], image2, scene().keypoints[1], scene().matches);
}

//! Share of refined points within a quarter of a pixel of the truth.
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
    forEveryNumberOfThreads([] { return refine(scene()); }, expectSame);
    const Refined expected = refine(scene());
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

// Angle -1, as matchRotated leaves it in the first image, is upright.
TEST(IIB_Refinement, starts_with_the_difference_of_angles)
{
    Mat turned;
    cv::rotate(scene().images[1], turned, ROTATE_90_CLOCKWISE);
    const Matx22d quarter(0, -1, 1, 0);
    const Vec2d shift = quarter * scene().shift + Vec2d(turned.cols - 1, 0);
    const float angles[][2] = {{-1, 90}, {40, 130}, {-1, 130}};  // of the keypoints of either image
    for (const auto& angle : angles)
    {
        std::vector<KeyPoint> first = scene().keypoints[0], second = scene().keypoints[1];
        for (KeyPoint& kp : first)
            kp.angle = angle[0];
        for (KeyPoint& kp : second)
        {
            kp.pt = Point2f(turned.cols - 1 - kp.pt.y, kp.pt.x);
            kp.angle = angle[1];
        }
        const Refined r = refine(scene().images[0], first, turned, second, scene().matches);
        const double right = rightShare(r, quarter * scene().linear, shift);
        EXPECT_TRUE(angle[0] < 0 && angle[1] > 90 ? right < .1 : right > .95) << angle[1] << ": " << right;
    }
}

// Matches of matchRotated, and of ORIENTATION_GRADIENT, whose keypoints have no angle.
TEST(IIB_Refinement, follows_turned_images_that_are_matched_in_either_way)
{
    for (double degrees : {0., 30., 90., 135., 200.})
        for (int orientation : {IIB::ORIENTATION_KEYPOINT, IIB::ORIENTATION_GRADIENT})
        {
            const Point2f centre((float)scene().images[0].cols / 2, (float)scene().images[0].rows / 2);
            Matx23d turn;
            Mat(getRotationMatrix2D(centre, -degrees, 1)).copyTo(turn);
            Mat turned;
            warpAffine(scene().images[0], turned, turn, scene().images[0].size(), INTER_LANCZOS4,
                    BORDER_REFLECT_101);
            const Ptr<IIB> iib = IIB::createRecommended(1000);
            const Ptr<HierarchicalMatcher> matcher = HierarchicalMatcher::createRecommended();
            iib->setOrientation(orientation);
            std::vector<KeyPoint> keypoints[2];
            std::vector<DMatch> matches;
            if (orientation == IIB::ORIENTATION_KEYPOINT)
                matchRotated(scene().images[0], turned, iib, matcher, keypoints[0], keypoints[1], matches);
            else
            {
                Mat codes[2];
                iib->detectAndCompute(scene().images[0], noArray(), keypoints[0], codes[0]);
                iib->detectAndCompute(turned, noArray(), keypoints[1], codes[1]);
                matcher->match(codes[0], codes[1], matches);
            }
            const Refined r = refine(scene().images[0], keypoints[0], turned, keypoints[1], matches);
            ASSERT_GT(r.points2.rows, 100);
            EXPECT_GT(rightShare(r, turn.get_minor<2, 2>(0, 0), Vec2d(turn(0, 2), turn(1, 2))), .9)
                    << degrees << ", " << orientation;
        }
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

// With wrong sizes of keypoints, up to eight times.
TEST(IIB_Refinement, no_point_moves_by_two_pixels)
{
    std::vector<KeyPoint> second = scene().keypoints[1];
    for (size_t i = 0; i < second.size(); i++)
    {
        second[i].pt += Point2f((float)(i % 7) - 3, (float)(i % 5) - 2);
        second[i].size *= (float)std::pow(2, (int)(i % 7) - 3);
    }
    const Refined r =
            refine(scene().images[0], scene().keypoints[0], scene().images[1], second, scene().matches);
    for (int i = 0; i < r.points2.rows; i++)
        EXPECT_LT(cv::norm(r.points2.at<Point2f>(i) - second[i].pt), 2) << i;
    EXPECT_GT(countNonZero(r.similarities > 0), .3 * r.points2.rows);
}

// Identical images, and shifts by whole pixels: errors and standard deviations are small.
TEST(IIB_Refinement, right_starts_are_the_best_there_are)
{
    const Mat image = scene().images[0];
    const Rect part(40, 30, 560, 400);
    for (const Point& shift : {Point(), Point(3, -5), Point(0, 1)})
    {
        const bool identical = shift == Point();
        const Mat fixed = identical ? image : image(part), moved = identical ? image : image(part - shift);
        std::vector<KeyPoint> first = scene().keypoints[0];
        for (KeyPoint& kp : first)
            kp.pt -= identical ? Point2f() : Point2f(part.tl());
        std::vector<KeyPoint> second = first;
        for (KeyPoint& kp : second)
            kp.pt += Point2f(shift);
        const Refined r = refine(fixed, first, moved, second, scene().matches);
        int exact = 0, inside = 0;
        for (int i = 0; i < r.points2.rows; i++)
        {
            if (!Rect2f(50, 50, (float)fixed.cols - 100, (float)fixed.rows - 100).contains(first[i].pt))
                continue;
            inside++;
            const Point3f covariance = r.covariances.at<Point3f>(i);
            const double error = cv::norm(r.points2.at<Point2f>(i) - second[i].pt);
            EXPECT_GT(r.similarities.at<float>(i), .99) << i;
            EXPECT_LT(error, .05);
            EXPECT_GT(std::min(covariance.x, covariance.z), 1e-7);
            EXPECT_GT((double)covariance.x * covariance.z, (double)covariance.y * covariance.y);
            EXPECT_LT(std::sqrt(std::max(covariance.x, covariance.z)), .06);
            exact += error == 0 && r.similarities.at<float>(i) == 1;
        }
        EXPECT_GT(inside, 100);
        EXPECT_EQ(identical ? inside : exact, exact);
    }
}

// A still camera, one of its pictures through JPEG: detected points are exact.
TEST(IIB_Refinement, right_starts_of_a_compressed_image)
{
    if (!haveImageWriter("image.jpg"))
        throw SkipTestException("this OpenCV writes no JPEG");
    for (int quality : {95, 80, 50})
    {
        std::vector<uchar> file;
        imencode(".jpg", scene().images[0], file, {IMWRITE_JPEG_QUALITY, quality});
        const Mat image = imdecode(file, IMREAD_GRAYSCALE);
        std::vector<KeyPoint> keypoints = scene().keypoints[0];
        const Refined r = refine(scene().images[0], keypoints, image, keypoints, scene().matches);
        double squares = 0;
        const int n = countNonZero(r.similarities > .5);
        for (int i = 0; i < r.points2.rows; i++)
        {
            const double sigmas =
                    inSigmas(r.points2.at<Point2f>(i) - keypoints[i].pt, r.covariances.at<Point3f>(i));
            squares += sigmas * sigmas / 2;
        }
        EXPECT_GT(n, .98 * r.points2.rows) << quality;
        EXPECT_LT(squares / n, 2.5) << quality;
    }
}

TEST(IIB_Refinement, gives_vectors_and_numbers_of_any_kind)
{
    const Refined expected = refine(scene());
    const int count = expected.points1.rows;  // of columns: OpenCV 5 makes a row of a vector
    const auto call = [](OutputArray a, OutputArray b, OutputArray c, OutputArray d) {
        refineMatches(scene().images[0], scene().keypoints[0], scene().images[1], scene().keypoints[1],
                scene().matches, a, b, c, d);
    };
    std::vector<Point2f> points1, points2(3);
    std::vector<Vec3f> covariances;
    std::vector<float> similarities;
    call(points1, points2, covariances, similarities);
    EXPECT_EQ(0, cvtest::norm(expected.points1.reshape(2), Mat(points1).reshape(2, count), NORM_INF));
    EXPECT_EQ(0, cvtest::norm(expected.points2.reshape(2), Mat(points2).reshape(2, count), NORM_INF));
    EXPECT_EQ(0, cvtest::norm(expected.covariances.reshape(3), Mat(covariances).reshape(3, count), NORM_INF));
    EXPECT_EQ(0, cvtest::norm(expected.similarities, Mat(similarities).reshape(1, count), NORM_INF));
    std::vector<Point2d> doubles;
    Mat_<Vec3d> wide;
    UMat onDevice;
    std::vector<double> all;
    call(doubles, onDevice, wide, all);
    EXPECT_EQ(Point2d(points1[5]), doubles[5]);
    EXPECT_EQ(Vec3d(covariances[5]), wide(5));
    EXPECT_EQ(similarities[5], all[5]);
    EXPECT_EQ(0, cvtest::norm(expected.points2, onDevice.getMat(ACCESS_READ), NORM_INF));
    std::vector<DMatch> none;
    propagateMatches(Mat(), {}, Mat(), {}, none, points1, doubles, wide, similarities);
    EXPECT_TRUE(points1.empty() && doubles.empty() && wide.empty() && similarities.empty());
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

TEST(IIB_Refinement, without_matches_all_is_empty_and_errors_say_what_is_wrong)
{
    const Refined none = refine(Mat(), {}, Mat(), {}, {});
    for (const Mat& m : {none.points1, none.points2, none.covariances, none.similarities})
        EXPECT_TRUE(m.empty());
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

}}  // namespace opencv_test
