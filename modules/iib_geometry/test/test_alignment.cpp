// SPDX-License-Identifier: Apache-2.0

#include "derivatives.hpp"
#include "opencv2/core/affine.hpp"
#include "opencv2/imgproc.hpp"
#include "pose/planar_problem.hpp"
#include "pose/uncertainty.hpp"
#include "test_precomp.hpp"

namespace opencv_test {
namespace {
using namespace cv::iib;

const Size SIZE(400, 300);

Mat spots(int seed, int count, const Size& size)
{
    RNG random(seed);
    Mat image(size, CV_8U, Scalar(120));
    for (int i = 0; i < count; i++)
    {
        const Point at(random.uniform(0, size.width), random.uniform(0, size.height));
        const Size axes(random.uniform(3, 30), random.uniform(3, 30));
        ellipse(image, at, axes, random.uniform(0., 180.), 0, 360, Scalar(random.uniform(20, 230)), FILLED,
                LINE_AA);
    }
    return image;
}

//! Patches of all sizes, another picture for each seed.
Mat picture(int seed)
{
    Mat image = spots(seed, 700, SIZE);
    GaussianBlur(image, image, Size(), .8);
    return image;
}

//! Half as bright, darker to one side, and noisy.
Mat inOtherLight(const Mat& image)
{
    Mat result = image.clone(), noise(image.size(), CV_16S);
    RNG random(9);
    random.fill(noise, RNG::NORMAL, 0, 2);
    for (int y = 0; y < image.rows; y++)
        for (int x = 0; x < image.cols; x++)
            result.at<uchar>(y, x) = saturate_cast<uchar>(
                    image.at<uchar>(y, x) * (.9 - .6 * x / image.cols) + 10 + noise.at<short>(y, x));
    return result;
}

//! Moved by a transform from the picture's pixels to the result's, in another light.
Mat moved(const Mat& picture, const Matx33d& transform)
{
    Mat result;
    warpPerspective(picture, result, transform, SIZE, INTER_CUBIC, BORDER_REFLECT);
    return inOtherLight(result);
}

std::vector<Point2d> corners(const Matx33d& transform)
{
    const double right = SIZE.width - 1, bottom = SIZE.height - 1;
    std::vector<Point2d> result;
    for (const Vec3d& corner :
            {Vec3d(0, 0, 1), Vec3d(right, 0, 1), Vec3d(right, bottom, 1), Vec3d(0, bottom, 1)})
    {
        const Vec3d q = transform * corner;
        result.push_back(Point2d(q[0] / q[2], q[1] / q[2]));
    }
    return result;
}

//! How far the corners of the image lie from the truth, at most, in pixels.
double cornerError(const Mat& found, const Matx33d& truth)
{
    const std::vector<Point2d> a = corners(found), b = corners(truth);
    double error = 0;
    for (int k = 0; k < 4; k++)
        error = std::max(error, cv::norm(a[k] - b[k]));
    return error;
}

const Matx33d TRANSLATION(1, 0, 7.3, 0, 1, -4.6, 0, 0, 1), SIMILARITY(1.04, -.1, 9, .1, 1.04, -12, 0, 0, 1),
        AFFINE(1.05, .03, 4, -.06, .97, 6, 0, 0, 1), HOMOGRAPHY(1.03, .04, 5, -.03, .98, 8, 1e-4, -8e-5, 1);

TEST(Alignment, finds_each_kind_of_transform_in_another_light)
{
    const Mat reference = picture(1);
    const std::pair<int, Matx33d> kinds[] = {{ALIGN_TRANSLATION, TRANSLATION}, {ALIGN_SIMILARITY, SIMILARITY},
            {ALIGN_AFFINE, AFFINE}, {ALIGN_HOMOGRAPHY, HOMOGRAPHY}};
    for (const auto& kind : kinds)
    {
        Mat transform, error, matches;
        ASSERT_TRUE(
                alignImages(reference, moved(reference, kind.second), transform, kind.first, error, matches));
        ASSERT_EQ(CV_64F, transform.type());
        EXPECT_EQ(1, transform.at<double>(2, 2));
        EXPECT_LT(cornerError(transform, kind.second.inv()), .15) << kind.first;
        ASSERT_EQ(Size(1, 4), error.size());
        EXPECT_GT(3 * cv::norm(error, NORM_INF), cornerError(transform, kind.second.inv()));
        EXPECT_LT(cv::norm(error, NORM_INF), .15);
        ASSERT_EQ(4, matches.cols);
        ASSERT_GE(matches.rows, 50);
        for (int i = 0; i < matches.rows; i++)
        {
            const Vec4f m = matches.at<Vec4f>(i);
            const Vec3d q = Matx33d(transform) * Vec3d(m[2], m[3], 1);
            EXPECT_LE(std::hypot(q[0] / q[2] - m[0], q[1] / q[2] - m[1]), 1.51);
        }
        const Matx33d T(transform);
        EXPECT_TRUE(kind.first == ALIGN_HOMOGRAPHY || T(2, 0) == 0);
        EXPECT_TRUE(kind.first != ALIGN_SIMILARITY || std::abs(T(0, 1) + T(1, 0)) < 1e-9);
        EXPECT_TRUE(kind.first != ALIGN_TRANSLATION || std::abs(T(0, 0) - 1) < 1e-12);
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
        Mat transform;
        ASSERT_TRUE(alignImages(reference, moved(reference, truth), transform, ALIGN_SIMILARITY)) << angle;
        EXPECT_LT(cornerError(transform, truth.inv()), .3);
    }
}

TEST(Alignment, refuses_images_of_other_scenes_and_without_points)
{
    Mat transform = Mat::eye(3, 3, CV_64F), error = transform, matches;
    EXPECT_FALSE(alignImages(picture(3), picture(4), transform, ALIGN_HOMOGRAPHY, error, matches));
    EXPECT_TRUE(transform.empty() && error.empty());
    EXPECT_LT(matches.rows, 16);
    EXPECT_FALSE(alignImages(picture(3), Mat(SIZE, CV_8U, Scalar(7)), transform));
    EXPECT_FALSE(alignImages(Mat(), picture(3), transform));
}

//! Three spots each: a dozen matches are all that there is, and that no wrong one is near tells little.
TEST(Alignment, refuses_a_few_matches_that_agree_by_chance)
{
    Mat images[2], transform, matches;
    for (int i = 0; i < 2; i++)
        GaussianBlur(spots(315 + i, 3, Size(200, 150)), images[i], Size(), 3);
    EXPECT_FALSE(alignImages(images[0], images[1], transform, ALIGN_SIMILARITY, noArray(), matches));
    EXPECT_GE(matches.rows, 4);
}

TEST(Alignment, refuses_pictures_that_share_a_part_alone_in_any_model)
{
    for (int side : {80, 115})
    {
        const Rect part(10, 10, side, side);
        Mat first = picture(11), second = picture(12), transform;
        for (const Mat& image : {first, second})
            picture(13)(part).copyTo(image(part));
        for (int model : {ALIGN_TRANSLATION, ALIGN_SIMILARITY, ALIGN_AFFINE, ALIGN_HOMOGRAPHY})
        {
            Mat matches;
            String reason;
            EXPECT_FALSE(alignImages(first, second, transform, model, noArray(), matches, &reason))
                    << side << " " << model;
            EXPECT_GE(matches.rows, 16) << "the part has enough of them";
            EXPECT_NE(reason.find("a logo"), String::npos) << reason;
        }
    }
}

//! As with a logo in one corner and a caption, or two stamps, between which nothing agrees.
TEST(Alignment, refuses_pictures_that_share_two_parts_alone)
{
    Mat first = picture(11), second = picture(12), transform;
    for (const Rect& part : {Rect(10, 10, 70, 70), Rect(320, 225, 70, 70)})
        for (const Mat& image : {first, second})
            picture(13)(part).copyTo(image(part));
    for (int model : {ALIGN_TRANSLATION, ALIGN_SIMILARITY, ALIGN_AFFINE, ALIGN_HOMOGRAPHY})
    {
        String reason;
        EXPECT_FALSE(alignImages(first, second, transform, model, noArray(), noArray(), &reason)) << model;
        EXPECT_NE(reason.find("logos"), String::npos) << reason;
    }
}

//! What shows in one of the images alone, by the other's mask or its black sky, could not agree.
TEST(Alignment, finds_a_part_that_is_all_that_both_images_show)
{
    const Mat reference = picture(1);
    const Rect part(150, 80, 126, 95);  // a tenth
    Mat mask = Mat::zeros(SIZE, CV_8U), night = Mat::zeros(SIZE, CV_8U), transform, error;
    mask(part) = 1;
    reference(part).copyTo(night(part));
    night *= .6;
    const auto expectFound = [&](const Mat& first, const Mat& second, int model, const Mat& allowed) {
        String reason;
        ASSERT_TRUE(ImageAligner::create(first, model)
                            ->align(second, transform, error, noArray(), &reason, allowed))
                << reason;
        EXPECT_LT(cornerError(transform, Matx33d::eye()), 3 * cv::norm(error, NORM_INF)) << model;
    };
    for (int model : {ALIGN_TRANSLATION, ALIGN_SIMILARITY, ALIGN_AFFINE, ALIGN_HOMOGRAPHY})
    {
        expectFound(reference, inOtherLight(reference), model, mask);
        expectFound(reference, night, model, Mat());
        expectFound(night, reference, model, Mat());
    }
}

//! A caption is no picture.
TEST(Alignment, refuses_a_logo_that_is_all_that_an_image_shows)
{
    const Rect part(10, 10, 80, 80);
    Mat transform;
    for (bool noisy : {false, true})  // noise has points, too
    {
        Mat black = Mat::zeros(SIZE, CV_8U), other = picture(12);
        for (const Mat& image : {black, other})
            picture(13)(part).copyTo(image(part));
        if (noisy)
            black = inOtherLight(black);
        for (int model : {ALIGN_TRANSLATION, ALIGN_SIMILARITY, ALIGN_AFFINE, ALIGN_HOMOGRAPHY})
        {
            String reason;
            EXPECT_FALSE(alignImages(other, black, transform, model, noArray(), noArray(), &reason)) << model;
            EXPECT_NE(reason.find("a logo"), String::npos) << reason;
            EXPECT_FALSE(alignImages(black, other, transform, model)) << model;
        }
    }
}

/** Squares of another depth, by a few pixels: the transform of one depth is as wrong of the other. Above the working size as well, where
matches of one depth alone are refined. */
TEST(Alignment, tells_what_a_part_of_the_images_is_beside_by)
{
    for (int times : {1, 4})
    {
        Mat reference;
        resize(picture(16), reference, Size(), times, times, INTER_CUBIC);
        const int beside = std::max(4, 2 * times), side = 60 * times;
        Mat image = reference.clone(), transform, error;
        for (int y = 0; y < reference.rows; y += side)
            for (int x = 0; x < reference.cols; x += 2 * side)
            {
                const int column = x + (y / side % 2) * side;
                const Rect square(column, y, std::min(side, reference.cols - beside - column), side);
                if (square.width <= 0)
                    continue;
                reference(square + Point(beside, 0)).copyTo(image(square));
            }
        String reason;
        ASSERT_TRUE(alignImages(reference, image, transform, ALIGN_HOMOGRAPHY, error, noArray(), &reason))
                << reason;
        for (int k = 0; k < 4; k++)
            EXPECT_GT(error.at<double>(k), beside / 2.) << times;
    }
}

//! A part of the picture as large as a third of it is no logo.
TEST(Alignment, finds_a_part_of_a_picture)
{
    const Mat whole = picture(14);
    Mat transform, error;
    ASSERT_TRUE(alignImages(
            whole, inOtherLight(whole(Rect(150, 40, 200, 200))), transform, ALIGN_TRANSLATION, error));
    EXPECT_NEAR(150, transform.at<double>(0, 2), .1);
    EXPECT_NEAR(40, transform.at<double>(1, 2), .1);
}

TEST(Alignment, refuses_a_model_that_is_not_true_and_tells_the_one_that_is)
{
    const Mat reference = picture(15);
    const Matx33d camera(360, 0, 200, 0, 360, 150, 0, 0, 1);
    const Matx33d turned = Affine3d(Vec3d(.02, .12, .01)).rotation();
    const Mat by = getRotationMatrix2D(Point2f(200, 150), 1, 1);
    Matx33d degree = Matx33d::eye();
    by.copyTo(Mat(degree, false).rowRange(0, 2));
    const struct
    {
        Matx33d truth;
        int model;
        const char* other;
        int right;
    } cases[] = {{camera * turned * camera.inv(), ALIGN_SIMILARITY, "HOMOGRAPHY agrees", ALIGN_HOMOGRAPHY},
            {HOMOGRAPHY, ALIGN_TRANSLATION, "agrees with", ALIGN_HOMOGRAPHY},
            {degree, ALIGN_TRANSLATION, "SIMILARITY agrees", ALIGN_SIMILARITY},
            {AFFINE, ALIGN_SIMILARITY, "AFFINE agrees", ALIGN_AFFINE}};
    for (const auto& c : cases)
    {
        const Mat image = moved(reference, c.truth);
        Mat transform, error;
        String reason;
        EXPECT_FALSE(alignImages(reference, image, transform, c.model, error, noArray(), &reason)) << c.other;
        EXPECT_TRUE(transform.empty() && error.empty());
        EXPECT_NE(reason.find(c.other), String::npos) << reason;
        EXPECT_TRUE(alignImages(reference, image, transform, c.right, error, noArray(), &reason)) << reason;
        EXPECT_EQ("", reason);
        EXPECT_LT(cornerError(transform, c.truth.inv()), .3) << c.other;
    }
}

//! With more freedom a transform comes nearer to noisy matches of whatever is true.
TEST(Alignment, noise_makes_no_model_of_more_freedom)
{
    const struct
    {
        int seed, times;  // as large as the picture
        double blur, noise;
    } cases[] = {{100, 1, 5, 15}, {100, 1, 8, 30}, {104, 1, 5, 5}, {103, 2, 6, 30}, {103, 2, 16, 5}};
    for (const auto& c : cases)
    {
        Mat whole, images[2], transform;
        resize(picture(c.seed), whole, Size(), c.times, c.times, INTER_CUBIC);
        const Rect part(0, 0, whole.cols - 20, whole.rows - 20);
        for (int i = 0; i < 2; i++)
        {
            Mat image = whole(part + Point(13, 7) * i).clone(), noise(image.size(), CV_16S);
            if (i)
                GaussianBlur(image, image, Size(), c.blur);
            RNG random(c.seed - 99 + i * 76);
            random.fill(noise, RNG::NORMAL, 0, c.noise);
            cv::add(image, noise, images[i], noArray(), CV_8U);
        }
        for (int model : {ALIGN_TRANSLATION, ALIGN_SIMILARITY, ALIGN_AFFINE})
        {
            String reason;
            EXPECT_TRUE(alignImages(images[0], images[1], transform, model, noArray(), noArray(), &reason))
                    << c.blur << " " << c.noise << ": " << reason;
        }
    }
}

//! By less than a pixel of the working size, or by so little that it shows at full size alone.
TEST(Alignment, refuses_a_model_that_is_not_true_of_large_images)
{
    const Size size(3200, 2400);
    for (double pixels : {2., 1.})  // at the corners
    {
        Mat reference, image, transform, error;
        resize(picture(24), reference, size, 0, 0, INTER_CUBIC);
        const Mat turn = getRotationMatrix2D(Point2f(1600, 1200), pixels / 2000 * 180 / CV_PI, 1);
        warpAffine(reference, image, turn, size, INTER_CUBIC, BORDER_REFLECT);
        String reason;
        EXPECT_FALSE(alignImages(reference, image, transform, ALIGN_TRANSLATION, error, noArray(), &reason));
        EXPECT_NE(reason.find("SIMILARITY agrees"), String::npos) << reason;
        ASSERT_TRUE(alignImages(reference, image, transform, ALIGN_SIMILARITY, error, noArray(), &reason))
                << reason;
        EXPECT_LT(cv::norm(error, NORM_INF), .5);
    }
}

//! The upper half is a wall that is twice as near as the lower one's.
TEST(Alignment, tells_a_camera_that_moved)
{
    const Mat wall = picture(16);
    Mat image = inOtherLight(wall), transform;
    wall(Rect(40, 0, 360, 150)).copyTo(image(Rect(0, 0, 360, 150)));
    wall(Rect(20, 150, 380, 150)).copyTo(image(Rect(0, 150, 380, 150)));
    String reason;
    EXPECT_FALSE(alignImages(wall, image, transform, ALIGN_AFFINE, noArray(), noArray(), &reason));
    EXPECT_NE(reason.find("parallax"), String::npos) << reason;
}

//! A third of what a camera that stayed sees moved one way: what it sees is all that there is to tell it from the one before.
TEST(Alignment, tells_what_may_be_shadows_that_moved)
{
    const Mat picture1 = picture(16);
    Mat image = inOtherLight(picture1), transform;
    const Mat shadows = inOtherLight(picture1(Rect(0, 0, 392, 100)));
    shadows.copyTo(image(Rect(8, 0, 392, 100)));
    String reason;
    EXPECT_FALSE(alignImages(picture1, image, transform, ALIGN_HOMOGRAPHY, noArray(), noArray(), &reason));
    EXPECT_NE(reason.find("parallax"), String::npos) << reason;
    EXPECT_NE(reason.find("shadows"), String::npos) << reason;
}

//! Of many pixels, and blurred: what the working size finds is refined as far as there is something to refine.
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
    EXPECT_THROW(alignImages(Mat(1100, 1100, CV_32S), large, transform), cv::Exception);
}

TEST(Alignment, gives_fixed_sizes)
{
    std::vector<Vec4f> matches(1);
    Mat all, found;
    ASSERT_TRUE(alignImages(picture(9), inOtherLight(picture(9)), found, ALIGN_HOMOGRAPHY, noArray(), all));
    ASSERT_TRUE(
            alignImages(picture(9), inOtherLight(picture(9)), found, ALIGN_HOMOGRAPHY, noArray(), matches));
    EXPECT_EQ(0, cvtest::norm(all, Mat(matches).reshape(1), NORM_INF));
    EXPECT_FALSE(alignImages(
            picture(9), Mat(SIZE, CV_8U, Scalar(90)), found, ALIGN_HOMOGRAPHY, noArray(), matches));
    EXPECT_TRUE(matches.empty());

    Matx33d transform;
    Vec4d error;
    ASSERT_TRUE(alignImages(picture(18), picture(18), transform, ALIGN_TRANSLATION, error));
    EXPECT_NEAR(0, transform(0, 2), 1e-3);
    EXPECT_GT(error[0],
            .4 * .1 * std::sqrt(2));  // which all matches may have in common: exact ones err by a tenth
    EXPECT_FALSE(alignImages(picture(18), picture(19), transform, ALIGN_TRANSLATION, error));
    EXPECT_TRUE(std::isnan(transform(1, 1)) && std::isnan(error[3]));
}

TEST(Alignment, mistakes_are_told)
{
    Mat transform;
    EXPECT_THROW(alignImages(picture(5), picture(5), transform, 4), cv::Exception);
    EXPECT_THROW(alignImages(picture(5), picture(5), transform, -1), cv::Exception);
    EXPECT_THROW(alignImages(picture(5), Mat(SIZE, CV_32S), transform), cv::Exception);
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

TEST(Alignment, looks_at_what_masks_allow)
{
    Mat reference = picture(1), image = moved(reference, Matx33d(1, 0, -30, 0, 1, -20, 0, 0, 1));
    const Rect banner(0, 0, 240, 180);  // which stays where it is
    picture(2)(banner).copyTo(reference(banner));
    picture(2)(banner).copyTo(image(banner));
    Mat mask(SIZE, CV_8U, Scalar(1)), transform;
    mask(Rect(0, 0, 250, 190)) = 0;
    EXPECT_FALSE(alignImages(reference, image, transform, ALIGN_TRANSLATION));
    const Ptr<ImageAligner> aligner = ImageAligner::create(reference, ALIGN_TRANSLATION, mask);
    ASSERT_TRUE(aligner->align(image, transform, noArray(), noArray(), nullptr, mask));
    EXPECT_NEAR(30, transform.at<double>(0, 2), .2);
    EXPECT_NEAR(20, transform.at<double>(1, 2), .2);
    for (const Mat& wrong : {Mat(mask(Rect(0, 0, 9, 9))), Mat(SIZE, CV_32F, Scalar(1))})
        EXPECT_ANY_THROW(ImageAligner::create(reference, ALIGN_TRANSLATION, wrong));
}

//! As large as it says, on average over many noisy sets of matches.
TEST(Alignment, deviation_foretells_the_errors_of_the_corners)
{
    RNG random(6);
    for (int kind : {ALIGN_TRANSLATION, ALIGN_SIMILARITY, ALIGN_AFFINE, ALIGN_HOMOGRAPHY})
    {
        double squares = 0;
        const int trials = 100;
        for (int trial = 0; trial < trials; trial++)
        {
            Mat image(120, 2, CV_64F), reference(120, 2, CV_64F);
            for (int i = 0; i < image.rows; i++)
                for (int c = 0; c < 2; c++)
                {
                    image.at<double>(i, c) = random.uniform(0., 300.);
                    reference.at<double>(i, c) =
                            i < 20 ? random.uniform(0., 300.) : image.at<double>(i, c) + random.gaussian(.4);
                }
            const PlanarProblem problem(reference, image, kind);
            const Fit<PlanarProblem> fit = robustFit(problem, 0);
            ASSERT_FALSE(fit.squared.empty());
            const Matx33d model = fit.model;
            const Vec3d place = problem.inPixels(model) * Vec3d(300, 300, 1);
            const double error = std::hypot(place[0] / place[2] - 300, place[1] / place[2] - 300);
            const double deviation = problem.deviation(
                    model, covarianceOf(problem, fit, partsOf(reference), 1e3), Point2d(300, 300));
            squares += error * error / (deviation * deviation) / trials;
        }
        EXPECT_GT(squares, .1) << kind;
        EXPECT_LT(squares, 1) << kind;
    }
}

TEST(Alignment, derivatives_are_those_of_finite_differences)
{
    RNG random(7);
    Mat image(40, 2, CV_64F), reference(40, 2, CV_64F);
    random.fill(image, RNG::UNIFORM, 0, 300);
    random.fill(reference, RNG::NORMAL, 0, 3);
    reference += image;
    const Matx33d model(1.01, .02, .01, -.01, .99, -.01, .01, .02, 1);
    for (int kind : {ALIGN_TRANSLATION, ALIGN_SIMILARITY, ALIGN_AFFINE, ALIGN_HOMOGRAPHY})
        expectDerivatives(PlanarProblem(reference, image, kind), model, 5, 1e-3);
}

}  // namespace
}  // namespace opencv_test
