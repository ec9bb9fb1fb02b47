// SPDX-License-Identifier: Apache-2.0

#include "alignment_pictures.hpp"
#include "../derivatives.hpp"
#include "pose/planar_problem.hpp"
#include "pose/uncertainty.hpp"

namespace opencv_test { namespace {
using namespace cv::iib;

TEST(Alignment, finds_each_kind_of_transform_in_another_light_and_chooses_the_simplest)
{
    const Mat reference = picture(1);
    for (int model : MODELS)
    {
        const Matx33d truth = TRUTHS[model].inv();
        const Mat image = moved(reference, TRUTHS[model]);
        const Aligned result(reference, image, model);
        ASSERT_TRUE(result.found) << result.reason;
        ASSERT_EQ(CV_64F, result.transform.type());
        EXPECT_EQ(1, result.at(2, 2));
        EXPECT_LT(result.cornerError(truth), .15) << model;
        ASSERT_EQ(Size(1, 4), result.error.size());
        EXPECT_GT(3 * result.largestError(), result.cornerError(truth));
        EXPECT_LT(result.largestError(), .15);
        ASSERT_EQ(4, result.matches.cols);
        ASSERT_GE(result.matches.rows, 50);
        for (int i = 0; i < result.matches.rows; i++)
        {
            const Vec4f m = result.matches.at<Vec4f>(i);
            const Vec3d q = Matx33d(result.transform) * Vec3d(m[2], m[3], 1);
            EXPECT_LE(std::hypot(q[0] / q[2] - m[0], q[1] / q[2] - m[1]), 1.51);
        }
        EXPECT_TRUE(model == ALIGN_HOMOGRAPHY || result.at(2, 0) == 0);
        EXPECT_TRUE(model != ALIGN_SIMILARITY || std::abs(result.at(0, 1) + result.at(1, 0)) < 1e-9);
        EXPECT_TRUE(model != ALIGN_TRANSLATION || std::abs(result.at(0, 0) - 1) < 1e-12);
        const Aligned chosen(reference, image, ALIGN_AUTO), rich(reference, image, ALIGN_HOMOGRAPHY);
        ASSERT_TRUE(chosen.found && rich.found) << chosen.reason << rich.reason;
        EXPECT_EQ(model, chosen.simplest);
        EXPECT_LT(chosen.cornerError(truth), result.cornerError(truth) + .02);
        EXPECT_EQ(model, rich.simplest);
        EXPECT_EQ(model == ALIGN_HOMOGRAPHY, rich.note.empty()) << rich.note;
    }
    EXPECT_EQ(-1, Aligned(reference, picture(2), ALIGN_AUTO).simplest);
}

//! Like drifting ice before a rock: a homography would fit parts of both.
TEST(Alignment, chooses_the_transform_of_the_static_part)
{
    const Mat reference = picture(41), ice = picture(42);
    Mat image = moved(reference, TRANSLATION), drifted, first = reference.clone(), x(SIZE, CV_32F),
        y = x.clone();
    for (int row = 0; row < SIZE.height; row++)
        for (int column = 0; column < SIZE.width; column++)
        {
            x.at<float>(row, column) = (float)(column + 9 + .03 * row + 2 * std::sin(column / 60.));
            y.at<float>(row, column) = (float)(row + 6 + .02 * column);
        }
    remap(ice, drifted, x, y, INTER_CUBIC, BORDER_REFLECT);
    ice.rowRange(190, 300).copyTo(first.rowRange(190, 300));
    drifted.rowRange(190, 300).copyTo(image.rowRange(190, 300));
    const Aligned chosen(first, image, ALIGN_AUTO);
    ASSERT_TRUE(chosen.found) << chosen.reason;
    EXPECT_EQ(ALIGN_TRANSLATION, chosen.simplest);
    EXPECT_LT(chosen.cornerError(TRANSLATION.inv()), .3);
}

//! For white noise, the estimated errors are neither too small nor too large. For equal images they do not grow with the size.
TEST(Alignment, errors_match_white_noise)
{
    double squares = 0;
    const int trials = 20;
    for (int trial = 0; trial < trials; trial++)
    {
        Mat images[2], noise(270, 360, CV_16S);
        RNG random(trial + 1);
        for (int i = 0; i < 2; i++)
        {
            random.fill(noise, RNG::NORMAL, 0, 6);
            cv::add(picture(50 + trial)(Rect(5 + 17 * i, 5 + 9 * i, 360, 270)), noise, images[i], noArray(),
                    CV_8U);
        }
        const Aligned result(images[0], images[1], ALIGN_TRANSLATION);
        ASSERT_TRUE(result.found) << result.reason;
        const double off = std::hypot(result.at(0, 2) - 17, result.at(1, 2) - 9);
        squares += std::pow(off / result.error.at<double>(0), 2) / trials;
    }
    EXPECT_GT(squares, .3);
    EXPECT_LT(squares, 2);
    for (int times : {1, 6})
    {
        Mat large;
        resize(picture(51), large, Size(), times, times, INTER_CUBIC);
        const Aligned result(large, large, ALIGN_TRANSLATION);
        EXPECT_TRUE(result.found && result.largestError() < .02) << times;
    }
}

TEST(Alignment, finds_images_that_are_turned)
{
    const Mat reference = picture(2);
    for (double angle : {90., 150.})
    {
        const Mat by = getRotationMatrix2D(Point2f(200, 150), angle, 1);
        Matx33d truth = Matx33d::eye();
        by.copyTo(Mat(truth, false).rowRange(0, 2));
        const Aligned result(reference, moved(reference, truth), ALIGN_SIMILARITY);
        ASSERT_TRUE(result.found) << angle;
        EXPECT_LT(result.cornerError(truth.inv()), .3);
    }
}

//! Large sharp images are refined at full size, blurred ones as far as possible.
TEST(Alignment, finds_large_and_blurred_images)
{
    Mat large, blurred, transform, error;
    resize(picture(17), large, Size(2400, 1800), 0, 0, INTER_CUBIC);
    const Mat image = large(Rect(40, 60, 2300, 1700));
    ASSERT_TRUE(alignImages(large, image, transform, ALIGN_SIMILARITY, error));
    EXPECT_NEAR(40, transform.at<double>(0, 2), .01);
    EXPECT_NEAR(60, transform.at<double>(1, 2), .01);
    GaussianBlur(image, blurred, Size(), 20);
    ASSERT_TRUE(alignImages(large, blurred, transform, ALIGN_SIMILARITY, error));
    EXPECT_NEAR(40, transform.at<double>(0, 2), 6);
    EXPECT_NEAR(60, transform.at<double>(1, 2), 6);
    warpPerspective(large, blurred, Matx33d(1, 0, 0, 0, 1, 0, 2e-5, 1e-5, 1), large.size(), INTER_LINEAR);
    ASSERT_TRUE(alignImages(large, blurred, transform, ALIGN_HOMOGRAPHY));
    EXPECT_NEAR(1, transform.at<double>(2, 2), 1e-12);
}

//! At full size a few of their matches agree, but not exactly.
TEST(Alignment, compares_dark_blurred_images_at_half_the_size)
{
    for (int seed : {17, 18, 19})
    {
        Mat sharp, exposed, dark, noise(900, 1200, CV_16S);
        resize(picture(seed), sharp, Size(1200, 900), 0, 0, INTER_CUBIC);
        GaussianBlur(sharp, sharp, Size(), 16);
        sharp.convertTo(exposed, CV_16S, .1);
        RNG(5).fill(noise, RNG::NORMAL, 0, 6);
        cv::add(exposed, noise, dark, noArray(), CV_8U);
        const Mat parts[] = {sharp(Rect(20, 30, 1150, 850)), dark(Rect(20, 30, 1150, 850))};
        for (bool swapped : {false, true})
        {
            const Aligned result(swapped ? dark : sharp, parts[!swapped], ALIGN_AUTO);
            ASSERT_TRUE(result.found) << result.reason;
            EXPECT_NEAR(20, result.at(0, 2), 1) << seed << swapped;
            EXPECT_NEAR(30, result.at(1, 2), 1) << seed << swapped;
            EXPECT_GE(result.matches.rows, 50) << seed << swapped;
        }
    }
}

TEST(Alignment, finds_large_images_that_are_turned_sharp_or_blurred)
{
    Mat large, turned, transform, error;
    resize(picture(17), large, Size(2400, 1800), 0, 0, INTER_CUBIC);
    rotate(large, turned, ROTATE_90_CLOCKWISE);
    ASSERT_TRUE(alignImages(large, turned, transform, ALIGN_SIMILARITY, error));
    EXPECT_LT(cv::norm(Matx33d(transform), Matx33d(0, 1, 0, -1, 0, 1799, 0, 0, 1), NORM_INF), .05);
    EXPECT_LT(cv::norm(error, NORM_INF), .5);
    GaussianBlur(turned, turned, Size(), 40);
    ASSERT_TRUE(alignImages(large, turned, transform, ALIGN_SIMILARITY, error));
    EXPECT_NEAR(1, transform.at<double>(0, 1), .03);
    EXPECT_NEAR(-1, transform.at<double>(1, 0), .03);
}

TEST(Alignment, keeps_the_scales_of_images_of_other_sizes)
{
    Mat large, transform;
    resize(picture(20), large, Size(1100, 825), 0, 0, INTER_CUBIC);
    ASSERT_TRUE(alignImages(large, large(Rect(60, 40, 1000, 700)), transform, ALIGN_TRANSLATION));
    EXPECT_NEAR(60, transform.at<double>(0, 2), .1);
    EXPECT_NEAR(40, transform.at<double>(1, 2), .1);
    Mat strip;
    resize(picture(21), strip, Size(7000, 100), 0, 0, INTER_CUBIC);
    ASSERT_TRUE(alignImages(strip, strip.colRange(500, 6500), transform, ALIGN_TRANSLATION));
    EXPECT_NEAR(500, transform.at<double>(0, 2), 2);
    resize(picture(20), large, Size(3300, 2475), 0, 0, INTER_CUBIC);
    ASSERT_TRUE(alignImages(large, picture(20), transform, ALIGN_SIMILARITY));
    EXPECT_NEAR(8.25, transform.at<double>(0, 0), .02);
    EXPECT_THROW(alignImages(Mat(1100, 1100, CV_32S), large, transform), cv::Exception);
}

TEST(Alignment, gives_fixed_sizes)
{
    std::vector<Vec4f> matches(1);
    Mat all, found;
    ASSERT_TRUE(alignImages(picture(9), inOtherLight(picture(9)), found, ALIGN_HOMOGRAPHY, noArray(), all));
    ASSERT_TRUE(
            alignImages(picture(9), inOtherLight(picture(9)), found, ALIGN_HOMOGRAPHY, noArray(), matches));
    EXPECT_EQ(0, cvtest::norm(all, Mat(matches).reshape(1, all.rows), NORM_INF));
    EXPECT_FALSE(alignImages(
            picture(9), Mat(SIZE, CV_8U, Scalar(90)), found, ALIGN_HOMOGRAPHY, noArray(), matches));
    EXPECT_TRUE(matches.empty());

    Matx33d transform;
    Vec4d error;
    ASSERT_TRUE(alignImages(picture(18), picture(18), transform, ALIGN_TRANSLATION, error));
    EXPECT_NEAR(0, transform(0, 2), 1e-3);
    EXPECT_LT(error[0], .01);
    EXPECT_FALSE(alignImages(picture(18), picture(19), transform, ALIGN_TRANSLATION, error));
    EXPECT_TRUE(std::isnan(transform(1, 1)) && std::isnan(error[3]));
}

TEST(Alignment, invalid_arguments_are_refused)
{
    Mat transform;
    EXPECT_THROW(alignImages(picture(5), picture(5), transform, 5), cv::Exception);
    EXPECT_THROW(alignImages(picture(5), picture(5), transform, -1), cv::Exception);
    for (const Size& size : {SIZE, Size(1100, 1100)})
        EXPECT_THROW(alignImages(picture(5), Mat(size, CV_32S), transform), cv::Exception);
}

TEST(Alignment, one_reference_serves_many_images_as_each_alone)
{
    const Mat reference = picture(1);
    const Ptr<ImageAligner> aligner = ImageAligner::create(reference, ALIGN_SIMILARITY);
    for (double angle : {3., 40., 5.})
    {
        const Mat turn = getRotationMatrix2D(Point2f(200, 150), angle, 1.05);
        const Mat image = moved(reference,
                Matx33d(turn.at<double>(0, 0), turn.at<double>(0, 1), turn.at<double>(0, 2),
                        turn.at<double>(1, 0), turn.at<double>(1, 1), turn.at<double>(1, 2), 0, 0, 1));
        Mat transform, error, matches, alone, aloneError, aloneMatches;
        ASSERT_TRUE(aligner->align(image, transform, error, matches));
        ASSERT_TRUE(alignImages(reference, image, alone, ALIGN_SIMILARITY, aloneError, aloneMatches));
        EXPECT_EQ(0, cvtest::norm(transform, alone, NORM_INF));
        EXPECT_EQ(0, cvtest::norm(error, aloneError, NORM_INF));
        EXPECT_EQ(0, cvtest::norm(matches, aloneMatches, NORM_INF));
    }
}

TEST(Alignment, matches_only_where_masks_allow)
{
    Mat reference = picture(1), image = moved(reference, Matx33d(1, 0, -30, 0, 1, -20, 0, 0, 1));
    const Rect banner(0, 0, 270, 200);  // does not move
    picture(2)(banner).copyTo(reference(banner));
    picture(2)(banner).copyTo(image(banner));
    Mat mask(SIZE, CV_8U, Scalar(1)), transform;
    mask(Rect(0, 0, 280, 210)) = 0;
    EXPECT_FALSE(alignImages(reference, image, transform, ALIGN_TRANSLATION));
    const Ptr<ImageAligner> aligner = ImageAligner::create(reference, ALIGN_TRANSLATION, mask);
    ASSERT_TRUE(aligner->align(image, transform, noArray(), noArray(), nullptr, mask));
    EXPECT_NEAR(30, transform.at<double>(0, 2), .2);
    EXPECT_NEAR(20, transform.at<double>(1, 2), .2);
    Mat same;
    ASSERT_TRUE(alignImages(
            reference, image, same, ALIGN_TRANSLATION, noArray(), noArray(), nullptr, mask, mask));
    EXPECT_EQ(0, cv::norm(same, transform, NORM_INF));
    for (const Mat& wrong : {Mat(mask(Rect(0, 0, 9, 9))), Mat(SIZE, CV_32F, Scalar(1))})
        EXPECT_ANY_THROW(ImageAligner::create(reference, ALIGN_TRANSLATION, wrong));
}

TEST(Alignment, matches_only_where_masks_allow_in_rotated_images)
{
    const Mat reference = picture(2);
    Mat image, mask(SIZE, CV_8U, Scalar(0)), transform, matches;
    rotate(reference, image, ROTATE_90_CLOCKWISE);
    mask.colRange(200, 400) = 1;
    const Ptr<ImageAligner> aligner = ImageAligner::create(reference, ALIGN_SIMILARITY, mask);
    ASSERT_TRUE(aligner->align(image, transform, noArray(), matches));
    for (int i = 0; i < matches.rows; i++)
        ASSERT_GE(matches.at<float>(i, 0), 199.f);

    Mat other(image.size(), CV_8U, Scalar(0));
    other.rowRange(200, 400) = 1;
    ASSERT_TRUE(ImageAligner::create(reference, ALIGN_SIMILARITY)
                        ->align(image, transform, noArray(), matches, nullptr, other));
    for (int i = 0; i < matches.rows; i++)  // refinement moves points by up to two pixels
        ASSERT_TRUE(matches.at<float>(i, 3) > 196 && matches.at<float>(i, 3) < 403);
}

/** Half of the squares are at another depth and displaced by a few pixels. The transform fits one depth, and the errors must include
the displacement of the other. In large images, only matches of one depth are refined at full size. */
TEST(Alignment, errors_include_the_displacement_of_a_part)
{
    for (int times : {1, 4})
    {
        Mat reference;
        resize(picture(16), reference, Size(), times, times, INTER_CUBIC);
        const int beside = std::max(4, 2 * times), side = 60 * times;
        Mat image = reference.clone();
        for (int y = 0; y < reference.rows; y += side)
            for (int x = 0; x < reference.cols; x += 2 * side)
            {
                const int column = x + (y / side % 2) * side;
                const Rect square(column, y, std::min(side, reference.cols - beside - column), side);
                if (square.width <= 0)
                    continue;
                reference(square + Point(beside, 0)).copyTo(image(square));
            }
        const Aligned result(reference, image, ALIGN_HOMOGRAPHY);
        ASSERT_TRUE(result.found) << result.reason;
        for (int k = 0; k < 4; k++)
            EXPECT_GT(result.error.at<double>(k), beside / 2.) << times;
    }
}

//! A third of the squares is off the plane, some by more than a shadow moves. The errors must include all of them.
TEST(Alignment, errors_include_depth_off_the_plane)
{
    const Mat reference = picture(16);
    Mat image = reference.clone();
    for (int k = 0; k < 48; k++)
        if (k * 7 % 12 >= 8)  // of twelve squares, two are displaced by 4 pixels and two by 9 to 16
        {
            const int by = k * 7 % 12 < 10 ? 4 : 9 + k * 5 % 8;
            const Rect square(k % 8 * 50, k / 8 * 50, std::min(50, 400 - by - k % 8 * 50), 50);
            reference(square + Point(by, 0)).copyTo(image(square));
        }
    const Aligned result(reference, image, ALIGN_HOMOGRAPHY);
    ASSERT_TRUE(result.found) << result.reason;
    EXPECT_GT(result.error.at<double>(0), 6);
}

//! Compares estimated and true errors, averaged over many noisy sets of matches.
TEST(Alignment, deviation_predicts_the_errors_of_the_corners)
{
    RNG random(6);
    for (int kind : {ALIGN_TRANSLATION, ALIGN_SIMILARITY, ALIGN_AFFINE, ALIGN_HOMOGRAPHY})
    {
        double squares = 0;
        const int trials = 100;
        for (int trial = 0; trial < trials; trial++)
        {
            Points image(120), reference(120);
            for (int i = 0; i < 120; i++)
                for (double Point2d::*axis : {&Point2d::x, &Point2d::y})
                {
                    image[i].*axis = random.uniform(0., 300.);
                    reference[i].*axis =
                            i < 20 ? random.uniform(0., 300.) : image[i].*axis + random.gaussian(.4);
                }
            const PlanarProblem problem(reference, image, kind);
            const Fit<PlanarProblem> fit = robustFit(problem);
            ASSERT_FALSE(fit.squared.empty());
            const Matx33d model = fit.model;
            const Vec3d place = problem.inPixels(model) * Vec3d(300, 300, 1);
            const double error = std::hypot(place[0] / place[2] - 300, place[1] / place[2] - 300);
            const double deviation = problem.deviation(model,
                    covarianceOf(problem, model, fit.scale, partsOf(reference), 1e3), Point2d(300, 300));
            squares += error * error / (deviation * deviation) / trials;
        }
        EXPECT_GT(squares, .1) << kind;
        EXPECT_LT(squares, 1) << kind;
    }
}

TEST(Alignment, derivatives_are_those_of_finite_differences)
{
    RNG random(7);
    Points image(40), reference;
    random.fill(image, RNG::UNIFORM, 0, 300);
    for (const Point2d& point : image)
        reference.push_back(point + Point2d(random.gaussian(3), random.gaussian(3)));
    const Matx33d model(1.01, .02, .01, -.01, .99, -.01, .01, .02, 1);
    for (int kind : {ALIGN_TRANSLATION, ALIGN_SIMILARITY, ALIGN_AFFINE, ALIGN_HOMOGRAPHY})
        expectDerivatives(PlanarProblem(reference, image, kind), model, 5, 1e-3);
}

}}  // namespace opencv_test
