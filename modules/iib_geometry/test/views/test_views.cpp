// SPDX-License-Identifier: Apache-2.0

#include "../alignment/alignment_pictures.hpp"
#include "opencv2/iib.hpp"
#include "opencv2/iib_geometry.hpp"
#include "views/view.hpp"

namespace opencv_test { namespace {
using namespace cv::iib;

Matx33d turned(double degrees)
{
    const double c = std::cos(degrees * CV_PI / 180), s = std::sin(degrees * CV_PI / 180);
    return {c, -s, 0, s, c, 0, 0, 0, 1};
}

//! Shortens an image by the tilt along a direction, then scales and rotates it, on a canvas that fits.
struct Change
{
    const char* name;
    double scale, degrees, tilt;
    int least;  //!< number of right matches

    Matx33d from(const Size& size, Size& canvas) const
    {
        const Matx33d shape =
                turned(degrees) * turned(-25) * Matx33d::diag({scale / tilt, scale, 1}) * turned(25);
        Mat at, low, high;
        perspectiveTransform(std::vector<Point2d>{{0, 0}, {size.width - 1., 0}, {0, size.height - 1.},
                                     {size.width - 1., size.height - 1.}},
                at, shape);
        reduce(at.reshape(1, 4), low, 0, REDUCE_MIN);
        reduce(at.reshape(1, 4), high, 0, REDUCE_MAX);
        const Vec2d from = low.at<Vec2d>(0), span = high.at<Vec2d>(0) - from;
        canvas = Size(cvCeil(span[0]) + 1, cvCeil(span[1]) + 1);
        return Matx33d(1, 0, -from[0], 0, 1, -from[1], 0, 0, 1) * shape;
    }

    Mat of(const Mat& image, Matx33d& truth) const
    {
        Size canvas;
        truth = from(image.size(), canvas);
        const int finer = 4;  // supersampling, like the area of a sensor's pixel
        const double shift = .5 * (finer - 1);
        Mat fine, result;
        warpPerspective(image, fine, Matx33d(finer, 0, shift, 0, finer, shift, 0, 0, 1) * truth,
                canvas * finer, INTER_LINEAR, BORDER_CONSTANT, Scalar(128));
        resize(fine, result, canvas, 0, 0, INTER_AREA);
        return inOtherLight(result);
    }
};

Mat largePicture(int seed)
{
    Mat image = spots(seed, 2500, Size(640, 480));
    GaussianBlur(image, image, Size(), .8);
    return image;
}

int countOfRight(const Mat& points1, const Mat& points2, const Matx33d& truth)
{
    int right = 0;
    for (int i = 0; i < points1.rows; i++)
    {
        const Vec3d q = truth * Vec3d(points1.at<float>(i, 0), points1.at<float>(i, 1), 1);
        right += std::hypot(q[0] / q[2] - points2.at<float>(i, 0), q[1] / q[2] - points2.at<float>(i, 1)) < 3;
    }
    return right;
}

TEST(Views, match_at_any_zoom_rotation_and_tilt)
{
    const Mat image = largePicture(1);
    for (const Change& change : {Change{"reduced", .25, 0, 1, 200}, Change{"enlarged", 2, 0, 1, 300},
                 Change{"rotated", 1, 45, 1, 500}, Change{"upside down", .5, 200, 1, 400},
                 Change{"tilted", 1, 0, 3, 250}, Change{"tilted much", 1, 0, 4, 150},
                 Change{"tilted and rotated", 1, 60, 2, 400}})
    {
        Matx33d truth;
        const Mat other = change.of(image, truth);
        for (bool swapped : {false, true})
        {
            const Mat images[] = {swapped ? other : image, swapped ? image : other};
            Mat points1, points2, covariances, similarities, view;
            String reason;
            ASSERT_TRUE(matchViews(images[0], images[1], points1, points2, covariances, similarities, view,
                    1000, 4, noArray(), noArray(), &reason))
                    << change.name << ": " << reason;
            EXPECT_EQ("", reason);
            const int right =
                    swapped ? countOfRight(points2, points1, truth) : countOfRight(points1, points2, truth);
            EXPECT_GE(right, change.least) << change.name << swapped;
            EXPECT_GE(right, .9 * points1.rows) << change.name << swapped;
            EXPECT_EQ(Size(3, points1.rows), covariances.size());
            EXPECT_EQ(Size(1, points1.rows), similarities.size());
            const Matx33d there = swapped ? Matx33d(view).inv() : Matx33d(view);
            EXPECT_LT(cv::norm(there * truth.inv(), Matx33d::eye(), NORM_INF), 5)
                    << change.name << swapped << view;
        }
    }
}

TEST(Views, align_reduced_and_tilted_images)
{
    const Mat image = largePicture(6);
    for (const Change& change : {Change{"reduced", .25, 0, 1, 0}, Change{"tilted and rotated", 1, 60, 2, 0}})
    {
        Matx33d truth;
        const Mat other = change.of(image, truth);
        const Aligned result(image, other, ALIGN_HOMOGRAPHY);
        ASSERT_TRUE(result.found) << result.reason;
        for (const Vec3d& corner : {Vec3d(0, 0, 1), Vec3d(639, 0, 1), Vec3d(639, 479, 1), Vec3d(0, 479, 1)})
        {
            const Vec3d back = Matx33d(result.transform) * truth * corner;
            EXPECT_LT(std::hypot(back[0] / back[2] - corner[0], back[1] / back[2] - corner[1]), 1.5)
                    << change.name;
        }
    }
}

TEST(Views, find_a_small_picture_on_a_large_map)
{
    const Size large(2600, 1800);
    Mat map = spots(3, 22000, large), other = spots(4, 700, SIZE);
    GaussianBlur(map, map, Size(), .8);
    for (const Change& change : {Change{"as it is", 1, 0, 1, 300}, Change{"rotated", 1, 130, 1, 300},
                 Change{"from nearer", 1.4, 70, 1, 150}, Change{"from farther", .6, -60, 1.3, 400}})
    {
        const Rect part(1700, 1100, cvRound(SIZE.width / change.scale), cvRound(SIZE.height / change.scale));
        Matx33d truth;
        const Mat picture = change.of(map(part), truth);
        truth = truth * Matx33d(1, 0, -part.x, 0, 1, -part.y, 0, 0, 1);
        Mat points1, points2;
        EXPECT_TRUE(matchViews(map, picture, points1, points2)) << change.name;
        EXPECT_GE(countOfRight(points1, points2, truth), change.least) << change.name;
        EXPECT_TRUE(matchViews(picture, map, points2, points1)) << change.name;
        EXPECT_GE(countOfRight(points1, points2, truth), change.least) << change.name;
        const Aligned result(map, picture, ALIGN_HOMOGRAPHY);
        ASSERT_TRUE(result.found) << change.name << ": " << result.reason;
        EXPECT_LT(result.cornerError(truth.inv()), 1) << change.name;
        EXPECT_GE(result.matches.rows, change.least) << change.name;
    }
    const Mat blank(SIZE, CV_8U, Scalar(7)), none(large, CV_8U, Scalar(0));
    for (const Mat& picture : {other, blank})
    {
        EXPECT_FALSE(matchViews(map, picture, noArray(), noArray()));
        for (bool swapped : {false, true})
        {
            const Aligned result(swapped ? picture : map, swapped ? map : picture, ALIGN_HOMOGRAPHY);
            EXPECT_FALSE(result.found);
            EXPECT_NE("", result.reason);
        }
    }
    Mat transform;
    EXPECT_FALSE(alignImages(map, map(Rect(Point(900, 700), SIZE)), transform, ALIGN_HOMOGRAPHY, noArray(),
            noArray(), nullptr, none));
}

// Matched with a whole map it is refused, although the map is not reduced; matched with its part of the map it is found.
TEST(Views, align_a_small_upright_picture)
{
    for (const auto& [seed, part] :
            {std::make_pair(3, Rect(670, 60, 140, 105)), {4, Rect(670, 360, 150, 112)}})
    {
        Mat map = spots(seed, 3000, Size(1000, 700));
        GaussianBlur(map, map, Size(), 1.5);
        const Aligned result(map, inOtherLight(map(part)), ALIGN_HOMOGRAPHY);
        ASSERT_TRUE(result.found) << seed << ": " << result.reason;
        EXPECT_NEAR(part.x, result.at(0, 2), .5);
        EXPECT_NEAR(part.y, result.at(1, 2), .5);
    }
}

TEST(Views, a_picture_of_the_same_part_with_fewer_pixels_has_as_many_matches)
{
    Mat image = spots(5, 6000, Size(1000, 750));
    GaussianBlur(image, image, Size(), 1.5);
    for (double scale : {.64, .55})
    {
        Mat smaller, points1, points2;
        cv::resize(image, smaller, Size(), scale, scale, INTER_AREA);
        EXPECT_TRUE(matchViews(image, smaller, points1, points2, noArray(), noArray(), noArray(), 2000));
        EXPECT_GE(points1.rows, 1000) << scale;
        EXPECT_GE(Aligned(image, smaller, ALIGN_HOMOGRAPHY).matches.rows, 1000) << scale;
    }
}

// Squared errors over variances are about one along each axis, whatever the view.
TEST(Views, covariances_are_of_pixels_of_the_image)
{
    Matx33d truth;
    const Mat image = largePicture(3)(Rect(200, 150, 220, 170)),
              other = Change{"", 2, 30, 2, 0}.of(image, truth);
    Mat points1, points2, covariances;
    ASSERT_TRUE(matchViews(image, other, points1, points2, covariances));
    ASSERT_GE(points1.rows, 50);
    double median[2];
    for (int axis = 0; axis < 2; axis++)
    {
        std::vector<double> errors;
        for (int i = 0; i < points1.rows; i++)
        {
            const Vec3d q = truth * Vec3d(points1.at<float>(i, 0), points1.at<float>(i, 1), 1);
            errors.push_back(
                    std::pow(q[axis] - points2.at<float>(i, axis), 2) / covariances.at<float>(i, 2 * axis));
        }
        std::nth_element(errors.begin(), errors.begin() + errors.size() / 2, errors.end());
        median[axis] = errors[errors.size() / 2];
        EXPECT_GT(median[axis], .005);
        EXPECT_LT(median[axis], 3);
    }
    EXPECT_NEAR(0, std::log(median[0] / median[1]), .5) << "of a tilted view, longer along one axis";
}

TEST(Views, an_ordinary_pair_gets_the_matches_of_the_chain)
{
    const Mat image = largePicture(3), other = inOtherLight(image);
    const Ptr<IIB> iib = IIB::createRecommended(500);
    std::vector<KeyPoint> keypoints1, keypoints2;
    Mat codes1, codes2, expected1, expected2, points1, points2, view;
    iib->detectAndCompute(image, noArray(), keypoints1, codes1);
    iib->detectAndCompute(other, noArray(), keypoints2, codes2);
    std::vector<DMatch> matches;
    HierarchicalMatcher::createRecommended()->match(codes1, codes2, matches);
    propagateMatches(image, keypoints1, other, keypoints2, matches, expected1, expected2);
    ASSERT_TRUE(matchViews(image, other, points1, points2, noArray(), noArray(), view, 500));
    EXPECT_EQ(0, cv::norm(points1, expected1, NORM_INF));
    EXPECT_EQ(0, cv::norm(points2, expected2, NORM_INF));
    EXPECT_LT(cv::norm(Matx33d(view), Matx33d::eye(), NORM_INF), .2);
}

TEST(Views, refuses_images_of_other_scenes)
{
    for (int seed = 0; seed < 6; seed++)
    {
        Mat points1, points2, view;
        String reason;
        EXPECT_FALSE(matchViews(picture(seed), picture(seed + 50), points1, points2, noArray(), noArray(),
                view, 1000, 4, noArray(), noArray(), &reason))
                << seed;
        EXPECT_FALSE(reason.empty());
        EXPECT_TRUE(view.empty());
        EXPECT_EQ(points1.size(), points2.size());
    }
    Mat smooth, mirrored, points1, points2;
    GaussianBlur(spots(1, 700, SIZE), smooth, Size(), 4);
    flip(smooth, mirrored, 1);
    // One of 348 pairs of views agrees by chance.
    EXPECT_FALSE(matchViews(smooth, mirrored, points1, points2));
    EXPECT_FALSE(matchViews(Mat(), picture(1), points1, points2));
    EXPECT_FALSE(matchViews(picture(1), Mat(300, 400, CV_8U, Scalar(9)), points1, points2));
    EXPECT_TRUE(points1.empty() && points2.empty());
    const Mat tiny(9, 7, CV_8U, Scalar(9)), mask(9, 7, CV_8U, Scalar(1));
    EXPECT_FALSE(
            matchViews(tiny, tiny, points1, points2, noArray(), noArray(), noArray(), 100, 4, mask, mask));
}

Mat wallWithWindows(const Mat& window, const std::vector<Point>& places)
{
    Mat wall(480, 640, CV_8U, Scalar(120));
    for (const Point& place : places)
        window.copyTo(wall(Rect(place, window.size())));
    GaussianBlur(wall, wall, Size(), .8);
    return wall;
}

/** The matches of each window agree, but not with those of the other one, which is five times nearer: no zoom that is searched. A window alone is
one structure. */
TEST(Views, refuses_equal_windows_at_other_places)
{
    for (int seed = 0; seed < 10; seed++)
    {
        const Mat window = spots(seed, 40, Size(30, 36)),
                  first = wallWithWindows(window, {{60, 200}, {520, 240}}),
                  second = inOtherLight(wallWithWindows(window, {{250, 200}, {335, 215}}));
        EXPECT_FALSE(matchViews(first, second, noArray(), noArray(), noArray(), noArray(), noArray(), 1000))
                << seed;
    }
}

TEST(Views, one_matcher_serves_many_images)
{
    const Mat image = largePicture(4);
    const Ptr<ViewMatcher> matcher = ViewMatcher::create(image, 600);
    const int threads = getNumThreads();
    for (const Change& change : {Change{"", .35, 30, 1, 0}, Change{"", 1, 0, 3, 0}, Change{"", 1, 90, 1, 0}})
    {
        Matx33d truth;
        const Mat other = change.of(image, truth);
        std::vector<Point2f> points1, points2;
        Mat alone1, alone2;
        ASSERT_TRUE(matcher->match(other, points1, points2));
        setNumThreads(1);
        ASSERT_TRUE(matchViews(image, other, alone1, alone2, noArray(), noArray(), noArray(), 600));
        setNumThreads(threads);
        EXPECT_EQ(0, cv::norm(Mat(points1).reshape(1, alone1.rows), alone1, NORM_INF));
        EXPECT_EQ(0, cv::norm(Mat(points2).reshape(1, alone2.rows), alone2, NORM_INF));
    }
}

TEST(Views, masks_hold_in_all_views)
{
    const Mat image = largePicture(5);
    Matx33d truth;
    const Mat other = Change{"", .5, 45, 1, 0}.of(image, truth);
    Mat mask(image.size(), CV_8U, Scalar(0)), points1, points2;
    mask.colRange(0, 320) = 255;
    ASSERT_TRUE(matchViews(image, other, points1, points2, noArray(), noArray(), noArray(), 1000, 4, mask));
    for (int i = 0; i < points1.rows; i++)
        EXPECT_LT(points1.at<float>(i, 0), 323);
    EXPECT_THROW(matchViews(image, other, points1, points2, noArray(), noArray(), noArray(), 1000, 4,
                         noArray(), mask),
            cv::Exception);
    EXPECT_THROW(ViewMatcher::create(image, -1), cv::Exception);
    for (double tilt : {.5, 9., std::numeric_limits<double>::quiet_NaN()})
        EXPECT_THROW(matchViews(image, other, points1, points2, noArray(), noArray(), noArray(), 1000, tilt),
                cv::Exception);
}

TEST(Views, show_two_images_in_one_shape_without_enlargement)
{
    RNG random(3);
    for (int trial = 0; trial < 200; trial++)
    {
        const double first = std::exp(random.uniform(-1.5, 1.5)),
                     second = std::exp(random.uniform(-1.5, 1.5));
        const Matx33d map = turned(random.uniform(0., 360.)) * Matx33d::diag({first, second, 1}) *
                            turned(random.uniform(0., 360.));
        const ViewPair pair = ViewPair::of(map);
        const Size size(640, 480);
        const Matx33d left = pair.views[1].fromImage(size) * map * pair.views[0].fromImage(size).inv() *
                             turned(-pair.angle);
        Vec2d scales;
        SVD::compute(left.get_minor<2, 2>(0, 0), scales, SVD::NO_UV);
        EXPECT_LT(scales[0], 1.3);
        EXPECT_GT(scales[1], 1 / 1.3);
        EXPECT_NEAR(left(0, 1), left(1, 0), .3);  // no rotation is left
        EXPECT_GT(left(0, 0), .7);
        for (const View& view : pair.views)
            EXPECT_LE(std::max(view.scales[0], view.scales[1]), 1);
    }
}

TEST(Views, are_enlarged_if_small_and_reduced_by_the_part_that_both_images_show)
{
    const auto scale = [](int most, const Size& first, const Size& second, const Point& shift) {
        const Matx33d map(1, 0, -shift.x, 0, 1, -shift.y, 0, 0, 1);
        return ViewPair::of(map).within(most, first, second, map).views[0].scales[0];
    };
    EXPECT_DOUBLE_EQ(1.6, scale(1024, Size(300, 200), Size(300, 200), Point()));
    EXPECT_DOUBLE_EQ(2, scale(1024, Size(200, 150), Size(200, 150), Point()));
    EXPECT_DOUBLE_EQ(1, scale(1024, Size(900, 700), Size(900, 700), Point()));
    EXPECT_DOUBLE_EQ(1024 / 3000., scale(1024, Size(3000, 2000), Size(3000, 2000), Point()));
    EXPECT_DOUBLE_EQ(1, scale(1024, Size(3000, 2000), Size(640, 480), Point(900, 700)));
    EXPECT_DOUBLE_EQ(.5, scale(512, Size(3000, 2000), Size(640, 480), Point(900, 700)));
    EXPECT_DOUBLE_EQ(1024 / 3000., scale(1024, Size(3000, 2000), Size(640, 480), Point(9000, 0)));
}

// A spot must appear where the view's map projects it.
TEST(Views, pixels_are_where_their_map_projects_them)
{
    const Point2d spot(201, 77);
    Mat image(300, 400, CV_32F, Scalar(0));
    circle(image, Point(spot), 9, Scalar(1), FILLED, LINE_AA);
    for (const View& view : {View::reduced(.5), View::reduced(1 / 3.), View::reduced(.37),
                 View::tilted(2, .5), View{1, {.4, .7}}})
    {
        Mat seen = view.pixels(image);
        ASSERT_EQ(view.sizeOf(image.size()), seen.size());
        const Mat mask = view.mask(image.size(), Mat());
        if (!mask.empty())
            seen.setTo(0, mask == 0);
        const Moments m = moments(seen);
        const Vec3d there = view.fromImage(image.size()) * Vec3d(spot.x, spot.y, 1);
        EXPECT_NEAR(there[0], m.m10 / m.m00, .1);
        EXPECT_NEAR(there[1], m.m01 / m.m00, .1);
    }
}

}}  // namespace opencv_test
