// SPDX-License-Identifier: Apache-2.0

#include "opencv2/iib/refinement.hpp"
#include "../wall.hpp"

namespace opencv_test { namespace {
using namespace cv::iib;

struct Localization : public WallTest
{
    const Localizer localizer{folder.path("map")};
};

TEST_F(Localization, under_changed_illumination)
{
    const cv::Mat image = wall.image(TRUTH);
    expectAt(TRUTH, localizer.localize(image, CAMERA), 0.01);
    cv::Mat dark, colour;
    image.convertTo(dark, CV_8U, 0.2, 5);
    expectAt(TRUTH, localizer.localize(dark, CAMERA), 0.02);
    cv::cvtColor(image, colour, cv::COLOR_GRAY2BGR);
    expectAt(TRUTH, localizer.localize(colour, CAMERA), 0.01);
    ASSERT_EQ(1u, localizer.cameras().size());
    EXPECT_EQ(CAMERA.parameters, localizer.cameras()[0].parameters);
}

TEST_F(Localization, of_files_with_a_rotated_image)
{
    const cv::Mat image = wall.image(TRUTH);
    for (int orientation : {3, 6, 8})
    {
        cv::Mat stored;
        cv::rotate(image, stored,
                orientation == 3   ? cv::ROTATE_180
                : orientation == 6 ? cv::ROTATE_90_COUNTERCLOCKWISE
                                   : cv::ROTATE_90_CLOCKWISE);
        const Camera camera = CAMERA.upright(orientation == 3 ? 3 : 14 - orientation);  // rotated back
        const Location location = localizer.localize(stored, camera, nullptr, orientation),
                       without = localizer.localize(stored, camera);
        for (const Location& found : {location, without})
        {
            ASSERT_TRUE(found.found) << found.reason;
            EXPECT_LT(cv::norm(centre(found) - TRUTH.translation()), 0.01);
        }
        const std::vector<cv::Point2d> projected =
                camera.project(inCamera(location.points, location.cameraFromWorld));
        for (size_t i = 0; i < projected.size(); i++)
            EXPECT_LT(cv::norm(projected[i] - location.pixels[i]), 2);
    }
    for (int orientation : {2, 4, 5, 7, 9})  // mirrored, and an invalid one
    {
        EXPECT_NE("", messageOf([&] { localizer.localize(image, CAMERA, nullptr, orientation); }));
        EXPECT_NE("", messageOf([&] { CAMERA.upright(orientation); }));
    }
}

cv::Affine3d rolled(const cv::Affine3d& worldFromCamera, double degrees)
{
    return worldFromCamera * cv::Affine3d(cv::Vec3d(0, 0, degrees * CV_PI / 180));
}

TEST_F(Localization, at_any_rotation_and_from_reduced_images)
{
    for (double degrees : {45., 200.})
    {
        const cv::Affine3d truth = rolled(TRUTH, degrees);
        expectAt(truth, localizer.localize(wall.image(truth), CAMERA), .02);
        const cv::Affine3d prior = inverse(truth);
        EXPECT_FALSE(localizer.localize(Wall(9).image(truth), CAMERA).found);
        EXPECT_FALSE(localizer.localize(wall.image(truth), CAMERA, &prior).found)
                << "a prior excludes a search";
    }
    cv::Mat small;
    cv::resize(wall.image(TRUTH), small, cv::Size(), .3, .3, cv::INTER_AREA);
    expectAt(TRUTH, localizer.localize(small, CAMERA.resized(small.size())), .05);
}

TEST_F(Localization, in_a_map_of_rotated_photographs)
{
    std::vector<PosedImage> images;
    for (int i = 0; i < 6; i++)
        images.push_back({std::to_string(i), CAMERA, inverse(rolled(pathPose(i), i % 2 * 130)), {}, {}});
    folder.makeFolder("rotated");
    writeModel(folder.path("rotated"), images);
    const Localizer rotated(folder.path("rotated"), [&](const std::string& name) {
        return Photograph(wall.image(inverse(images[size_t(std::stoi(name))].cameraFromWorld)));
    });
    expectAt(TRUTH, rotated.localize(wall.image(TRUTH), CAMERA), .02);
}

// A symmetric part of a mirrored image agrees with a wrong pose.
TEST_F(Localization, mirrored_images_are_refused_where_a_part_is_symmetric)
{
    const Affine3d pose = poseAt(.1, 0, .05);
    const Mat image = wall.image(pose);
    Mat mirrored;
    flip(image, mirrored, 1);
    const Rect part(110, 60, 110, 130);
    Mat mostlyMirrored = mirrored.clone(), mostlyRight = image.clone();
    image(part).copyTo(mostlyMirrored(part));
    mirrored(part).copyTo(mostlyRight(part));
    const Location wrong = localizer.localize(mostlyMirrored, CAMERA),
                   right = localizer.localize(mostlyRight, CAMERA);
    EXPECT_FALSE(wrong.found);
    EXPECT_EQ(wrong.reason, "the image is mirrored: flip it");
    expectAt(pose, right, .05);
}

TEST_F(Localization, uses_only_what_a_mask_allows)
{
    cv::Mat mask(SIZE, CV_8U, cv::Scalar(1));
    mask.colRange(0, SIZE.width / 2) = 0;
    const Location location = localizer.localize(wall.image(TRUTH), CAMERA, nullptr, 1, mask);
    expectAt(TRUTH, location, 0.05);
    for (const cv::Point2d& pixel : location.pixels)
        EXPECT_GE(pixel.x, SIZE.width / 2 - 1);
    EXPECT_EQ("a mask must be CV_8UC1 and of its image's size",
            messageOf([&] { localizer.localize(wall.image(TRUTH), CAMERA, nullptr, 1, mask.t()); }));
}

TEST_F(Localization, with_distorted_cameras)
{
    for (const char* text : {"SIMPLE_RADIAL,320,240,240,160,120,-0.1", "RADIAL,320,240,240,160,120,-0.1,0.02",
                 "OPENCV,320,240,240,242,161,119,-0.1,0.02,0.002,-0.001",
                 "OPENCV_FISHEYE,320,240,200,201,161,119,0.02,-0.01,0.003,0.001"})
    {
        const Camera camera = Camera::parse(text);
        std::vector<cv::Point2d> pixels;
        for (int i = 0; i < SIZE.area(); i++)
            pixels.emplace_back(i % SIZE.width, i / SIZE.width);
        const Lens lens(camera);
        const cv::Matx33d straight = Lens(CAMERA).matrix() * lens.matrix().inv();
        cv::Mat at(SIZE, CV_32FC2), seen;
        std::vector<cv::Point2d> undistorted = lens.undistorted(pixels);
        cv::perspectiveTransform(undistorted, undistorted, straight);
        for (int i = 0; i < SIZE.area(); i++)
            at.at<cv::Vec2f>(i) = cv::Vec2f(float(undistorted[size_t(i)].x), float(undistorted[size_t(i)].y));
        cv::remap(wall.image(TRUTH), seen, at, cv::noArray(), cv::INTER_CUBIC);
        SCOPED_TRACE(text);
        expectAt(TRUTH, localizer.localize(seen, camera), 0.02);
    }
}

cv::Mat noisy(const cv::Mat& image, cv::RNG& random)
{
    cv::Mat noise(image.size(), CV_16S), result;
    random.fill(noise, cv::RNG::NORMAL, 0, 6);
    cv::add(image, noise, result, cv::noArray(), CV_8U);
    return result;
}

TEST_F(Localization, covariance_matches_repeated_measurements)
{
    const cv::Mat image = wall.image(TRUTH);
    cv::RNG random(5);
    cv::Vec6d squares, reported;
    constexpr int COUNT = 20;
    for (int i = 0; i < COUNT; i++)
    {
        const Location location = localizer.localize(noisy(image, random), CAMERA);
        ASSERT_TRUE(location.found) << location.reason;
        const cv::Vec3d moved = centre(location) - TRUTH.translation();
        const cv::Vec3d turned = cv::Affine3d((TRUTH * location.cameraFromWorld).rotation().t()).rvec();
        for (int k = 0; k < 3; k++)
        {
            squares[k] += moved[k] * moved[k] / COUNT;
            squares[k + 3] += turned[k] * turned[k] / COUNT;
        }
        for (int k = 0; k < 6; k++)
            reported[k] += location.covariance(k, k) / COUNT;
    }
    for (int k = 0; k < 6; k++)
    {
        EXPECT_GT(squares[k], 0.1 * reported[k]) << k;
        EXPECT_LT(squares[k], 9 * reported[k]) << k;
    }
}

// Without guided matches the error is .67 mm.
TEST_F(Localization, guided_matches_improve_poses)
{
    constexpr int COUNT = 12;
    cv::RNG random(3);
    double squares = 0;
    for (int i = 0; i < COUNT; i++)
    {
        const cv::Affine3d truth = poseAt(0.1 * i - 0.6, -0.1, 0.02 * i);
        const Location location = localizer.localize(noisy(wall.image(truth), random), CAMERA);
        ASSERT_TRUE(location.found) << location.reason;
        squares += std::pow(cv::norm(centre(location) - truth.translation()), 2) / COUNT;
    }
    EXPECT_LT(std::sqrt(squares), 0.00055);
}

TEST_F(Localization, prepared_images_are_refined_like_images)
{
    const cv::Mat one = wall.image(TRUTH), other = wall.image(poseAt(.12, -.1, .1));
    std::vector<cv::KeyPoint> keypoints[2];
    std::vector<cv::DMatch> matches;
    for (int i = 0; i < 50; i++)
    {
        for (std::vector<cv::KeyPoint>& k : keypoints)
            k.emplace_back(cv::Point2f(float(20 + 5 * i), float(30 + 3 * i)), 12.f);
        matches.emplace_back(i, i, 0.f);
    }
    cv::Mat a[4], b[4];
    const auto expectSame = [&] {
        for (int i = 0; i < 4; i++)
            EXPECT_EQ(0, cv::norm(a[i], b[i], cv::NORM_INF)) << i;
    };
    const PreparedImage first(one), second(other);
    refineMatches(one, keypoints[0], other, keypoints[1], matches, a[0], a[1], a[2], a[3]);
    refineMatches(first, keypoints[0], second, keypoints[1], matches, b[0], b[1], b[2], b[3]);
    EXPECT_GT(cv::countNonZero(a[3] > 0), 10);
    expectSame();
    std::vector<cv::DMatch> some(matches.begin(), matches.begin() + 25), others = some;
    propagateMatches(one, keypoints[0], other, keypoints[1], some, a[0], a[1], a[2], a[3]);
    propagateMatches(first, keypoints[0], second, keypoints[1], others, b[0], b[1], b[2], b[3]);
    EXPECT_GT(some.size(), 25u);
    ASSERT_EQ(some.size(), others.size());
    const auto partsOf = [](const cv::DMatch& m) {
        return std::make_tuple(m.queryIdx, m.trainIdx, m.imgIdx, m.distance);
    };
    for (size_t i = 0; i < some.size(); i++)
        EXPECT_EQ(partsOf(some[i]), partsOf(others[i])) << i;
    expectSame();
    EXPECT_NE("", messageOf([] { PreparedImage{cv::Mat()}; }));
}

TEST_F(Localization, threads_share_a_localizer)
{
    std::vector<cv::Mat> images;
    std::vector<Location> alone, atOnce(8);
    for (int i = 0; i < int(atOnce.size()); i++)
    {
        images.push_back(wall.image(poseAt(0.1 * i - 0.4, -0.1, 0.02 * i)));
        alone.push_back(localizer.localize(images.back(), CAMERA));
    }
    cv::parallel_for_(cv::Range(0, int(images.size())), [&](const cv::Range& range) {
        for (size_t i = size_t(range.start); i < size_t(range.end); i++)
            atOnce[i] = localizer.localize(images[i], CAMERA);
    });
    for (size_t i = 0; i < images.size(); i++)
    {
        ASSERT_TRUE(alone[i].found && atOnce[i].found) << i;
        EXPECT_EQ(alone[i].cameraFromWorld.matrix, atOnce[i].cameraFromWorld.matrix) << i;
    }
}

TEST_F(Localization, a_prior_gates_and_is_not_needed)
{
    const cv::Affine3d prior = inverse(poseAt(0.15, -0.05, 0.1)),
                       away = inverse(poseAt(0.1, -0.1, 0.1 + CV_PI));
    const cv::Mat image = wall.image(TRUTH);
    const Location free = localizer.localize(image, CAMERA),
                   gated = localizer.localize(image, CAMERA, &prior);
    expectAt(TRUTH, gated, 0.01);
    // A prior compares two images of the map instead of five.
    EXPECT_LT(gated.matches, free.matches);
    const Location recovered = localizer.localize(image, CAMERA, &away);
    EXPECT_EQ(free.cameraFromWorld.matrix, recovered.cameraFromWorld.matrix) << "whole map searched";
}

TEST_F(Localization, an_unknown_place_and_empty_images_get_no_pose)
{
    for (uint64 seed = 2; seed < 7; seed++)
        EXPECT_FALSE(localizer.localize(Wall(seed).image(poseAt(0, 0, 0)), CAMERA).found);
    EXPECT_EQ("too few matches", localizer.localize(cv::Mat(SIZE, CV_8U, cv::Scalar(7)), CAMERA).reason);
    EXPECT_EQ("the image has 64 x 48 pixels and its camera 320 x 240",
            messageOf([&] { localizer.localize(cv::Mat(48, 64, CV_8U), CAMERA); }));
    Camera camera = CAMERA;
    camera.model = "FOV";
    EXPECT_NE("", messageOf([&] { localizer.localize(cv::Mat(SIZE, CV_8U), camera); }));
    for (int type : {CV_16UC1, CV_32FC1, CV_8UC4})
        EXPECT_EQ("an image must be 8-bit, grey or BGR, not " + cv::typeToString(type),
                messageOf([&] { localizer.localize(cv::Mat(SIZE, type, cv::Scalar()), CAMERA); }));
}

TEST_F(Localization, points_are_checked_before_a_map_is_read_or_made)
{
    const std::string message = "points is -1: it must be 0, for as many as the map's images have, or more";
    EXPECT_EQ(message, messageOf([&] { Localizer(folder.path("map"), -1); }));
    EXPECT_EQ(message, messageOf([&] { Localizer(folder.path("gone"), -1); }));
    EXPECT_EQ(message, messageOf([&] { Localizer(folder.path("gone"), images(), -1); }));
}

TEST_F(Localization, codes_of_another_descriptor_are_refused)
{
    for (MapImage& image : map.images)
        image.codes = image.codes.colRange(0, 64).clone();
    MapFolder(folder.path("map")).write(map);
    EXPECT_EQ("the map's codes are of another version: make the map again",
            messageOf([&] { Localizer(folder.path("map")); }));
}

}}  // namespace opencv_test
