// SPDX-License-Identifier: Apache-2.0

#include "alignment_pictures.hpp"
#include "opencv2/core/affine.hpp"

// Which alignments are refused, and the reported errors and notes of accepted ones.
namespace opencv_test { namespace {
using namespace cv::iib;

TEST(Alignment, refuses_images_of_other_scenes_and_without_points)
{
    Mat transform = Mat::eye(3, 3, CV_64F), error = transform, matches;
    String reason;
    EXPECT_FALSE(alignImages(picture(3), picture(4), transform, ALIGN_HOMOGRAPHY, error, matches, &reason));
    EXPECT_NE(reason.find("could be random"), String::npos) << reason;
    EXPECT_TRUE(transform.empty() && error.empty());
    EXPECT_LT(matches.rows, 16);
    EXPECT_FALSE(alignImages(picture(3), Mat(SIZE, CV_8U, Scalar(7)), transform));
    EXPECT_FALSE(alignImages(Mat(), picture(3), transform));
}

//! Images of three spots have a dozen matches. That none of so few wrong matches is near says little about their chance.
TEST(Alignment, refuses_a_few_matches_that_agree_by_chance)
{
    Mat images[2];
    for (int i = 0; i < 2; i++)
        GaussianBlur(spots(315 + i, 3, Size(200, 150)), images[i], Size(), 3);
    const Aligned result(images[0], images[1], ALIGN_SIMILARITY);
    EXPECT_FALSE(result.found);
    EXPECT_GE(result.matches.rows, 4);
}

//! A mask of rectangles.
Mat maskOf(const std::vector<Rect>& parts)
{
    Mat mask(SIZE, CV_8U, Scalar(0));
    for (const Rect& part : parts)
        mask(part) = 1;
    return mask;
}

//! Different pictures share parts that are equal to the pixel: a logo, a car's bonnet, a frame, four captions.
TEST(Alignment, refuses_pictures_that_share_parts_alone)
{
    const std::vector<int> all(MODELS, MODELS + 4), two = {ALIGN_TRANSLATION, ALIGN_HOMOGRAPHY};
    const struct
    {
        Mat shared;
        std::vector<int> models;
        int least;  // matches
    } cases[] = {{maskOf({{10, 10, 80, 80}}), all, 16}, {maskOf({{10, 10, 115, 115}}), all, 16},
            {maskOf({{0, 220, 400, 80}}), two, 0}, {1 - maskOf({{20, 20, 360, 260}}), two, 0},
            {maskOf({{10, 8, 120, 34}, {260, 8, 120, 34}, {10, 258, 120, 34}, {260, 258, 120, 34}}), two, 0}};
    for (const auto& c : cases)
        for (int model : c.models)
        {
            Mat images[] = {picture(11), picture(12)};
            for (Mat& image : images)
                picture(13).copyTo(image, c.shared);
            const Aligned result(images[0], images[1], model);
            EXPECT_TRUE(result.isRefused("equal to the pixel")) << model << ": " << result.reason;
            EXPECT_GE(result.matches.rows, c.least);
        }
}

/** Small parts that are not equal to the pixel: a logo, two captions, a large logo of few spots, logos that a homography joins with distant wrong
matches, so that the inliers span a large area. */
TEST(Alignment, refuses_small_parts_in_other_light)
{
    const std::vector<int> two = {ALIGN_TRANSLATION, ALIGN_HOMOGRAPHY};
    const struct
    {
        int seed, logo, count;  // count: of the logo's spots
        double blur;
        std::vector<Rect> parts;
        std::vector<int> models;
    } cases[] = {{11, 13, 700, .8, {{10, 10, 80, 80}}, two},
            {24, 13, 3000, .6, {{10, 10, 72, 64}, {318, 226, 72, 64}}, two},
            {43, 243, 70, 2, {{20, 150, 110, 100}}, {ALIGN_TRANSLATION}},
            {48, 13, 700, .8, {{15, 15, 58, 58}}, {ALIGN_HOMOGRAPHY}},
            {54, 13, 700, .8, {{15, 15, 62, 62}}, {ALIGN_HOMOGRAPHY}}};
    for (const auto& c : cases)
    {
        Mat images[] = {picture(c.seed), picture(c.seed + 100)}, logo = spots(c.logo, c.count, SIZE);
        GaussianBlur(logo, logo, Size(), c.blur);
        logo.copyTo(images[0], maskOf(c.parts));
        warpAffine(logo, logo, Matx23d(1, 0, .5, 0, 1, .4), SIZE, INTER_CUBIC);
        logo.copyTo(images[1], maskOf(c.parts));
        for (int model : c.models)
        {
            const Aligned result(images[0], inOtherLight(images[1]), model);
            EXPECT_TRUE(result.isRefused("only in small parts")) << c.seed << ": " << result.reason;
        }
    }
}

//! The rest of the picture is hidden in one image, by a mask or a black sky, so it has no matches.
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
    for (int model : MODELS)
    {
        expectFound(reference, inOtherLight(reference), model, mask);
        expectFound(reference, night, model, Mat());
        expectFound(night, reference, model, Mat());
    }
}

//! A few matches in a narrow part agree, but they do not determine a homography far from it.
TEST(Alignment, refuses_a_transform_that_is_uncertain_at_the_corners)
{
    for (const auto& [seed, part] :
            {std::make_pair(14, Size(48, 20)), {16, Size(110, 14)}, {28, Size(140, 8)}})
    {
        Mat mask = Mat::zeros(SIZE, CV_8U), transform;
        mask(Rect(Point(20, 20), part)) = 1;
        String reason;
        EXPECT_FALSE(alignImages(picture(seed), inOtherLight(picture(seed)), transform, ALIGN_HOMOGRAPHY,
                noArray(), noArray(), &reason, noArray(), mask));
        EXPECT_NE(reason.find("uncertain by a quarter"), String::npos) << seed << ": " << reason;
    }
}

//! One image shows nothing but a logo.
TEST(Alignment, refuses_a_logo_that_is_all_that_an_image_shows)
{
    const Rect part(10, 10, 80, 80);
    for (bool noisy : {false, true})  // noise has keypoints too
    {
        Mat black = Mat::zeros(SIZE, CV_8U), other = picture(12);
        for (const Mat& image : {black, other})
            picture(13)(part).copyTo(image(part));
        if (noisy)
            black = inOtherLight(black);
        for (int model : MODELS)
        {
            EXPECT_TRUE(Aligned(other, black, model).isRefused("a logo")) << model;
            EXPECT_FALSE(Aligned(black, other, model).found) << model;
        }
    }
}

//! However many matches a logo at two places has, it is small; a larger part at the same places is one that both show.
TEST(Alignment, refuses_a_logo_at_two_places)
{
    Mat fine;
    resize(picture(13), fine, Size(), .5, .5, INTER_AREA);
    for (int side : {76, 120})
    {
        Mat images[2];
        for (int i = 0; i < 2; i++)
        {
            images[i] = picture(11 + i);
            fine(Rect(10, 0, side, side)).copyTo(images[i](Rect(14 + 175 * i, 14 + 100 * i, side, side)));
            resize(i ? inOtherLight(images[i]) : images[i], images[i], Size(), 2, 2, INTER_CUBIC);
        }
        for (int model : {ALIGN_TRANSLATION, ALIGN_HOMOGRAPHY})
            for (int k : {0, 1})
                EXPECT_EQ(side > 100, Aligned(images[k], images[1 - k], model).found) << side;
    }
}

TEST(Alignment, names_exposure_and_overlap)
{
    Mat white;
    picture(1).convertTo(white, CV_8U, 16);
    EXPECT_TRUE(Aligned(picture(1), white, ALIGN_HOMOGRAPHY).isRefused("of the image is black or white"));
    const Mat wide = spots(5, 700, Size(700, 300));
    EXPECT_TRUE(
            Aligned(wide.colRange(0, 360), wide.colRange(340, 700), ALIGN_HOMOGRAPHY).isRefused("overlap"));
}

//! A third of the picture is too large for a logo.
TEST(Alignment, finds_a_part_of_a_picture)
{
    const Mat whole = picture(14);
    const Aligned result(whole, inOtherLight(whole(Rect(150, 40, 200, 200))), ALIGN_TRANSLATION);
    ASSERT_TRUE(result.found) << result.reason;
    EXPECT_NEAR(150, result.at(0, 2), .1);
    EXPECT_NEAR(40, result.at(1, 2), .1);
}

TEST(Alignment, refuses_an_untrue_model_and_names_the_true_one)
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
        const Aligned untrue(reference, image, c.model), right(reference, image, c.right);
        EXPECT_TRUE(untrue.isRefused(c.other)) << c.other << ": " << untrue.reason;
        EXPECT_TRUE(untrue.transform.empty() && untrue.error.empty());
        ASSERT_TRUE(right.found) << right.reason;
        EXPECT_EQ("", right.reason);
        EXPECT_LT(right.cornerError(c.truth.inv()), .3) << c.other;
    }
}

//! A transform with more freedom always fits noisy matches more closely; this must not refute the true model.
TEST(Alignment, noise_does_not_refute_a_simple_model)
{
    const struct
    {
        int seed, times;  // times: the picture's enlargement
        double blur, noise;
    } cases[] = {{100, 1, 5, 15}, {100, 1, 8, 30}, {104, 1, 5, 5}, {103, 2, 6, 30}, {103, 2, 16, 5}};
    for (const auto& c : cases)
    {
        Mat whole, images[2];
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
            EXPECT_EQ("", Aligned(images[0], images[1], model).reason) << c.blur << " " << c.noise;
    }
}

//! Lenses bend images at their borders: in small images a few matches, in large ones each match a little.
TEST(Alignment, distortion_does_not_refute_a_simple_model)
{
    const struct
    {
        Size size;
        double bend, blur;  // bend: pixels in the middle of the left and right sides
    } cases[] = {{Size(120, 90), 2.5, 1.5}, {SIZE, .9, 2}};
    for (const auto& c : cases)
        for (int seed = 3; seed < 5; seed++)
        {
            const Mat reference = picture(seed)(Rect(Point(), c.size));
            Mat places(c.size, CV_32FC2), image;
            const Point2d centre(c.size.width / 2., c.size.height / 2.);
            for (int y = 0; y < c.size.height; y++)
                for (int x = 0; x < c.size.width; x++)
                {
                    const Point2d from = (Point2d(x, y) - centre) / centre.x;
                    places.at<Point2f>(y, x) = Point2d(x + 5, y + 3) + c.bend * from.dot(from) * from;
                }
            remap(reference, image, places, noArray(), INTER_CUBIC, BORDER_REFLECT);
            GaussianBlur(image, image, Size(), c.blur);
            const Aligned result(reference, image, ALIGN_TRANSLATION);
            ASSERT_TRUE(result.found) << result.reason;
            EXPECT_LT(result.cornerError({1, 0, 5, 0, 1, 3, 0, 0, 1}), .3);
        }
}

//! A rotation of less than a pixel at the working size, visible only at full size.
TEST(Alignment, refuses_an_untrue_model_of_large_images)
{
    const Size size(3200, 2400);
    for (double pixels : {2., 1.})  // at the corners
    {
        Mat reference, image;
        resize(picture(24), reference, size, 0, 0, INTER_CUBIC);
        const Mat turn = getRotationMatrix2D(Point2f(1600, 1200), pixels / 2000 * 180 / CV_PI, 1);
        warpAffine(reference, image, turn, size, INTER_CUBIC, BORDER_REFLECT);
        EXPECT_TRUE(Aligned(reference, image, ALIGN_TRANSLATION).isRefused("SIMILARITY agrees"));
        const Aligned right(reference, image, ALIGN_SIMILARITY);
        ASSERT_TRUE(right.found) << right.reason;
        EXPECT_LT(right.largestError(), .5);
    }
}

//! Strips at many depths: nearer ones move by more.
TEST(Alignment, refuses_parallax)
{
    const Mat wall = picture(16);
    Mat image = inOtherLight(wall);
    const Mat relit = image.clone();
    for (int y = 0; y < 300; y += 30)
    {
        const int by = y < 120 ? 20 : 20 + y / 4;
        relit(Rect(by, y, 400 - by, 30)).copyTo(image(Rect(0, y, 400 - by, 30)));
    }
    EXPECT_TRUE(Aligned(wall, image, ALIGN_AFFINE).isRefused("parallax"));
}

/** A third of the image moves, like a second plane or a block of text below an added line. The rest has a transform that is as exact
as its matches. In large images, only the matches of the rest are refined at full size. */
TEST(Alignment, finds_the_static_part_beside_a_part_that_moved)
{
    for (int times : {1, 4})
    {
        Mat picture1;
        resize(picture(16), picture1, Size(), times, times, INTER_CUBIC);
        for (const Point& by : {Point(8, 0) * times, Point(0, -40) * times})
        {
            Mat image = inOtherLight(picture1);
            const Rect part(0, by.y < 0 ? 150 * times : 0, 392 * times, 110 * times);
            inOtherLight(picture1)(part + by).copyTo(image(part));
            const Aligned result(picture1, image, ALIGN_HOMOGRAPHY);
            ASSERT_TRUE(result.found) << result.reason;
            EXPECT_LT(result.cornerError(Matx33d::eye()), .3 * times);
            EXPECT_LT(result.largestError(), .5 * times);
            EXPECT_NE(result.note.find("moved otherwise"), String::npos) << result.note;
        }
    }
}

//! More than half of the image moves by a homography. A translation is true of the rest.
TEST(Alignment, keeps_a_simple_model_of_its_own_part)
{
    const Mat reference = picture(16);
    const Matx33d by(1, 0, 4, 0, 1, -3, 0, 0, 1);
    Mat image = moved(reference, HOMOGRAPHY);
    moved(reference, by).rowRange(0, 120).copyTo(image.rowRange(0, 120));
    const Aligned result(reference, image, ALIGN_TRANSLATION);
    ASSERT_TRUE(result.found) << result.reason;
    EXPECT_LT(result.cornerError(by.inv()), .3);
}

/** Two blocks of text are rotated, and the second one moved. A similarity is true of the first block. A translation of the second block has
many matches too, but a similarity is better there. */
TEST(Alignment, chooses_no_untrue_model_of_another_part)
{
    RNG random(7);
    const Matx23d rotation(1.004, .007, 3, -.007, 1.004, -4);
    for (int trial = 0; trial < 4; trial++)
    {
        Mat images[] = {Mat(900, 700, CV_8U, Scalar(245)), Mat(900, 700, CV_8U, Scalar(245))};
        for (int line = 0; line < 22; line++)
        {
            String text;
            for (int k = 0; k < 36; k++)
                text += (char)random.uniform('a', 'z' + 3);
            for (int i = 0; i < 2; i++)
                putText(images[i], text, Point(50, 60 + 34 * (line + (i && line >= 11))),
                        FONT_HERSHEY_SIMPLEX, .65, Scalar(30), 1, LINE_AA);
        }
        warpAffine(images[1], images[1], rotation, Size(), INTER_CUBIC, BORDER_REPLICATE);
        images[1] *= .8;
        const Aligned result(images[0], images[1], ALIGN_AUTO);
        ASSERT_TRUE(result.found) << result.reason;
        double error = 1;
        for (int by : {0, 34})
        {
            const Matx33d truth = Matx33d(rotation(0, 0), rotation(0, 1), rotation(0, 2), rotation(1, 0),
                                          rotation(1, 1), rotation(1, 2), 0, 0, 1) *
                                  Matx33d(1, 0, 0, 0, 1, by, 0, 0, 1);
            error = std::min(error, result.cornerError(truth.inv()));
        }
        EXPECT_LT(error, .5);
    }
}

//! Repeated letters lie beside the transform, as if the camera had moved.
TEST(Alignment, finds_a_text_in_which_letters_changed)
{
    const auto page = [](int seed, bool isEdited) {
        RNG letters(seed), others(seed + 99);
        Mat image(600, 500, CV_8U, Scalar(245));
        for (int line = 0; line < 14; line++)
        {
            String text;
            for (int k = 0; k < 24; k++)
            {
                const char letter = (char)letters.uniform('a', 'e'), other = (char)others.uniform('a', 'e');
                text += isEdited && (line + k / 6) % 3 == 0 ? other : letter;
            }
            putText(image, text, Point(40, 60 + 38 * line), FONT_HERSHEY_SIMPLEX, .65, Scalar(30), 1,
                    LINE_AA);
        }
        return image;
    };
    for (int seed = 16; seed < 20; seed++)
    {
        Mat image;
        warpAffine(page(seed, true) * .8, image, Matx23d(1.004, .007, 3, -.007, 1.004, -4), Size(),
                INTER_CUBIC, BORDER_REPLICATE);
        const Aligned result(page(seed, false), image, ALIGN_HOMOGRAPHY);
        EXPECT_TRUE(result.found) << result.reason;
    }
}

//! Like land in a corner of the image, beside waves that cannot match.
TEST(Alignment, finds_a_place_in_one_part_of_the_image)
{
    const Matx33d by(1, 0, 3, 0, 1, -2, 0, 0, 1);
    for (double times : {1., 3.})
    {
        Mat reference = picture(31), image = picture(32);
        const Rect land(0, 150, 190, 150);  // a quarter
        const Mat land1 = picture(33);
        land1(land).copyTo(reference(land));
        moved(land1, by)(land).copyTo(image(land));
        resize(reference, reference, Size(), times, times, INTER_CUBIC);
        resize(image, image, Size(), times, times, INTER_CUBIC);
        for (int swapped = 0; swapped < 2; swapped++)
        {
            const Aligned result(swapped ? image : reference, swapped ? reference : image, ALIGN_HOMOGRAPHY);
            ASSERT_TRUE(result.found) << result.reason;
            const Vec3d corner = Matx33d(result.transform) * Vec3d(0, 299 * times, 1);
            EXPECT_NEAR((swapped ? 3 : -3) * times, corner[0] / corner[2], 1);
            EXPECT_NE(result.note.find("one part"), String::npos) << result.note;
            EXPECT_GT(result.error.at<double>(1), 2 * result.error.at<double>(3)) << "far from the matches";
        }
    }
}

//! Frames of a telescope: the stars moved, and the camera's hot pixels, or dust of five pixels, did not.
TEST(Alignment, refuses_hot_pixels_and_dust)
{
    for (int arm : {0, 1})
    {
        RNG random(3);
        Mat sky[2], images[2];
        for (Mat& each : sky)
        {
            each.create(300, 400, CV_32F);
            random.fill(each, RNG::NORMAL, 30, 3);
        }
        for (int star = 0; star < 20; star++)
        {
            const Point at(random.uniform(10, 340), random.uniform(10, 250));
            for (int i = 0; i < 2; i++)
                for (int y = -5; y <= 5; y++)
                    for (int x = -5; x <= 5; x++)
                        sky[i].at<float>(at + Point(x + 40 * i, y + 30 * i)) +=
                                (float)(90 * std::exp(-(x * x + y * y) / 4.));
        }
        for (int mark = 0; mark < 300; mark++)
        {
            const Point at(random.uniform(1, 399), random.uniform(1, 299));
            for (Mat& each : sky)
                for (int k = -arm; k <= arm; k++)
                    each.at<float>(at + Point(k, 0)) = each.at<float>(at + Point(0, k)) = 200;
        }
        for (int i = 0; i < 2; i++)
            sky[i].convertTo(images[i], CV_8U);
        EXPECT_TRUE(Aligned(images[0], images[1], ALIGN_TRANSLATION).isRefused("hot pixels"));
    }
}

}}  // namespace opencv_test
