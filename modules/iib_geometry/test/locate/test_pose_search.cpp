// SPDX-License-Identifier: Apache-2.0

#include "locate/pose_search.hpp"
#include "pose/camera_pose.hpp"
#include "../test_precomp.hpp"

namespace opencv_test { namespace {
using namespace cv::iib;

const Camera VGA = {"PINHOLE", {640, 480}, {500, 500, 320, 240}};
const Affine3d HERE(Vec3d(.1, -.2, .05), Vec3d(.3, -.1, .2));

//! A map of points without pictures, and matches with an image.
struct PoseProblem
{
    Map map;
    std::vector<Match> matches;

    //! Adds a match whose pixel has an error.
    void add(const Point2d& pixel, double depth, const Point2d& off = Point2d())
    {
        const Matx33d matrix = VGA.matrix();
        const Vec3d ray((pixel.x - matrix(0, 2)) / matrix(0, 0), (pixel.y - matrix(1, 2)) / matrix(1, 1), 1);
        const int number = int(matches.size()), views = 4;  // with too few matches to refine
        map.images.resize(views);
        map.points.push_back(inverse(HERE) * Point3d(ray * depth));
        matches.push_back({pixel + off, map.points.back(), number, number, 0, number % views, 0});
    }

    //! Adds a match at a random depth.
    void addAnywhere(RNG& random, const Point2d& pixel, const Point2d& off)
    {
        add(pixel, random.uniform(3., 6.), off);
    }

    void find(LocatedImage& found) const
    {
        PreparedPictures pictures(map.images.size());
        findPose(matches, map, pictures, found);
    }

    LocatedImage found() const
    {
        LocatedImage image;
        image.features.camera = VGA;
        image.features.picture = pictureOf(Mat(VGA.size, CV_8U, Scalar(128)));
        find(image);
        return image;
    }

    Location located() const { return found().location; }
};

Point2d anyPixel(RNG& random) { return {random.uniform(0., 640.), random.uniform(0., 480.)}; }

Point2d anyError(RNG& random, double pixels) { return {random.gaussian(pixels), random.gaussian(pixels)}; }

// With only one shuffle of matches in the significance test, which may leave right ones, 17 of these 60 poses were
// refused.
TEST(PoseSearch, few_matches_that_all_agree_give_a_pose)
{
    RNG random(5);
    for (int trial = 0; trial < 60; trial++)
    {
        PoseProblem problem;
        for (const Point2d& corner : {Point2d(60, 50), {560, 70}, {90, 400}, {540, 420}, {300, 220}})
        {
            const Point2d place = corner + anyError(random, 20);
            for (const Point2d& beside : {Point2d(-6, -6), {6, -6}, {-6, 6}, {6, 6}})
                problem.addAnywhere(random, place + beside, anyError(random, .5));
        }
        const Location found = problem.located();
        EXPECT_TRUE(found.found) << trial << ": " << found.reason;
    }
}

TEST(PoseSearch, an_image_is_prepared_once_for_a_prior_and_without_one)
{
    RNG random(5);
    PoseProblem problem;
    for (int i = 0; i < 40; i++)
        problem.addAnywhere(random, anyPixel(random), Point2d());
    LocatedImage found = problem.found();
    EXPECT_TRUE(found.location.found) << found.location.reason;
    found.features.picture = Picture();  // cannot be prepared
    EXPECT_NO_THROW(problem.find(found));
}

TEST(PoseSearch, matches_in_one_window_give_no_pose)
{
    RNG random(6);
    for (int trial = 0; trial < 10; trial++)
    {
        PoseProblem problem;
        for (int i = 0; i < 60; i++)
        {
            const bool right = i < 20;
            const Point2d pixel = right ? Point2d(300, 200) + 4 * Point2d(i % 5, i / 5) : anyPixel(random);
            problem.addAnywhere(random, pixel, right ? Point2d() : anyPixel(random) - pixel);
        }
        const Location found = problem.located();
        EXPECT_FALSE(found.found);
        EXPECT_EQ("the matches that agree could be random", found.reason);
        EXPECT_GE(found.inliers, 16) << "which is enough";
    }
}

//! The squared Mahalanobis length of a pose's error: six in the mean for a correct covariance.
double squaredError(const Affine3d& pose, const Matx66d& covariance)
{
    const Vec3d moved = inverse(HERE).translation() - inverse(pose).translation(),
                turned = -Affine3d(pose.rotation().t() * HERE.rotation()).rvec();
    const Vec6d error(moved[0], moved[1], moved[2], turned[0], turned[1], turned[2]);
    return error.dot(covariance.inv(DECOMP_SVD) * error);
}

TEST(ClusteredCovariance, predicts_errors_that_neighbours_share)
{
    RNG random(7);
    const int trials = 100, perSide = 4;
    for (double shared : {0., 1.})
    {
        double squared = 0, unclustered = 0;
        for (int trial = 0; trial < trials; trial++)
        {
            Point2d ofCell[perSide * perSide];
            for (Point2d& error : ofCell)
                error = anyError(random, shared);
            PoseProblem problem;
            for (int i = 0; i < 240; i++)
            {
                const Point2d pixel = anyPixel(random);
                problem.addAnywhere(random, pixel,
                        ofCell[int(pixel.x / 160) + perSide * int(pixel.y / 120)] + anyError(random, .5));
            }
            Affine3d pose = HERE;
            Matx66d covariance;
            ASSERT_TRUE(refinePose(problem.matches, Lens(VGA), pose, covariance));
            unclustered += squaredError(pose, covariance) / trials;
            ASSERT_TRUE(clusteredCovariance(problem.matches, Lens(VGA), pose, covariance));
            squared += squaredError(pose, covariance) / trials;
        }
        EXPECT_GT(squared, 6 * .4) << shared;
        EXPECT_LT(squared, 6 * 1.5) << shared;
        EXPECT_TRUE(shared == 0 || unclustered > 6 * 4) << unclustered << ", without clusters";
    }
}

TEST(ClusteredCovariance, fails_for_a_degenerate_pose)
{
    PoseProblem problem;
    for (const Point2d& pixel : {Point2d(100, 100), {500, 300}})
        problem.add(pixel, 4);
    Matx66d covariance = Matx66d::eye();
    EXPECT_FALSE(clusteredCovariance(problem.matches, Lens(VGA), HERE, covariance));
}

}}  // namespace opencv_test
