// SPDX-License-Identifier: Apache-2.0

#include "../src/line_features.hpp"
#include "wall.hpp"

namespace {
using namespace iib_localization;

//! Stripes across and upright, and points only in the middle.
cv::Mat stripesWithFewPoints()
{
    cv::Mat texture(900, 1200, CV_8U, cv::Scalar(120));
    for (int v = 20; v < 900; v += 60)
        texture(cv::Rect(0, v, 480, 25)) = 170;
    for (int u = 720; u < 1200; u += 60)
        texture(cv::Rect(u, 0, 25, 900)) = 70;
    cv::Mat noise(12, 12, CV_8U), points = texture(cv::Rect(540, 390, 120, 120));
    cv::RNG(3).fill(noise, cv::RNG::UNIFORM, 40, 220);
    cv::resize(noise, points, points.size(), 0, 0, cv::INTER_NEAREST);
    return texture;
}

TEST_F(Localization, with_depth_in_another_light)
{
    sources.depth = folder.path("depth");
    writeMap(placeOfMap(folder.path("map")), buildMap(sources));
    const Map map = readMap(folder.path("map"));
    const Pose truth = poseAt(0.1, -0.1, 0.1);
    const cv::Mat image = wall.image(truth);
    expectFound(map, image, truth, 0.01);
    cv::Mat dark;
    image.convertTo(dark, CV_8U, 0.2, 5);
    expectFound(map, dark, truth, 0.02);
}

TEST_F(Localization, with_triangulated_points)
{
    const Map map = buildMap(sources);
    const Pose truth = poseAt(0.1, -0.1, 0.1);
    expectFound(map, wall.image(truth), truth, 0.01);
}

TEST_F(Localization, the_other_features_too)
{
    sources.depth = folder.path("depth");
    const Pose truth = poseAt(0.1, -0.1, 0.1);
    for (const char* name : {"own", "sift"})
    {
        sources.features = name;
        expectFound(buildMap(sources), wall.image(truth), truth, 0.02);
    }
}

TEST_F(Localization, several_images_at_once)
{
    sources.depth = folder.path("depth");
    const Map map = buildMap(sources);
    const Localizer localizer(map, CAMERA);
    std::vector<cv::Mat> images;
    std::vector<Location> alone, atOnce(8);
    for (int i = 0; i < int(atOnce.size()); i++)
    {
        images.push_back(wall.image(poseAt(0.1 * i - 0.4, -0.1, 0.02 * i)));
        alone.push_back(localizer.locate(images.back()));
    }
    cv::parallel_for_(cv::Range(0, int(images.size())), [&](const cv::Range& range) {
        for (size_t i = size_t(range.start); i < size_t(range.end); i++)
            atOnce[i] = localizer.locate(images[i]);
    });
    for (size_t i = 0; i < images.size(); i++)
    {
        ASSERT_TRUE(alone[i].found && atOnce[i].found) << i;
        EXPECT_EQ(alone[i].estimate.pose.position, atOnce[i].estimate.pose.position) << i;
        EXPECT_EQ(alone[i].estimate.pose.rotation.coeffs(), atOnce[i].estimate.pose.rotation.coeffs()) << i;
    }
}

class LocalizationByLines : public Localization
{
protected:
    LocalizationByLines() : Localization(Wall(stripesWithFewPoints())) {}

    //! The mean errors of five poses in metres: without and with lines.
    std::pair<double, double> errors(const Map& map)
    {
        std::pair<double, double> means(0, 0);
        cv::RNG random(7);
        for (int i = 0; i < 5; i++)
        {
            const Pose truth =
                    poseAt(random.uniform(-0.5, 0.5), random.uniform(-0.2, 0.2), random.uniform(0., 0.15));
            cv::Mat image = wall.image(truth), noise(SIZE, CV_16S);
            random.fill(noise, cv::RNG::NORMAL, 0, 3);
            cv::add(image, noise, image, cv::noArray(), CV_8U);
            const Location without = Localizer(map, CAMERA, Lines::OFF).locate(image);
            const Location with = Localizer(map, CAMERA).locate(image);
            EXPECT_TRUE(without.found && with.found) << without.reason << with.reason;
            EXPECT_TRUE(without.lineInliers.empty());
            EXPECT_GE(with.lineInliers.size(), 10u);
            EXPECT_LT(with.metres, without.metres) << "surer";
            means.first += (without.estimate.pose.position - truth.position).norm() / 5;
            means.second += (with.estimate.pose.position - truth.position).norm() / 5;
        }
        return means;
    }
};

TEST_F(LocalizationByLines, helps_where_points_are_few)
{
    if (!linesAvailable())
        return;
    sources.depth = folder.path("depth");
    writeMap(placeOfMap(folder.path("map")), buildMap(sources));
    const auto [without, with] = errors(readMap(folder.path("map")));
    EXPECT_LT(with, 0.5 * without);
    EXPECT_LT(with, 0.01);
}

TEST_F(LocalizationByLines, triangulated_ones_too)
{
    if (!linesAvailable())
        return;
    const auto [without, with] = errors(buildMap(sources));
    EXPECT_LT(with, 0.7 * without);
}

TEST_F(Localization, an_unknown_place_and_bad_images_get_no_pose)
{
    sources.depth = folder.path("depth");
    const Map map = buildMap(sources);
    const Localizer localizer(map, CAMERA);
    for (uint64 seed = 2; seed < 7; seed++)
        EXPECT_FALSE(localizer.locate(Wall(seed).image(poseAt(0, 0, 0))).found);
    EXPECT_EQ("the image cannot be read", localizer.locate(cv::Mat()).reason);
    EXPECT_EQ("the image has 64 x 48 pixels and the camera 320 x 240",
            localizer.locate(cv::Mat(48, 64, CV_8U)).reason);
    EXPECT_EQ("too few matches", localizer.locate(cv::Mat(SIZE, CV_8U, cv::Scalar(7))).reason);
}

TEST_F(Localization, a_prior_takes_the_place_of_the_vote)
{
    sources.depth = folder.path("depth");
    const Map map = buildMap(sources);
    const Pose truth = poseAt(0.1, -0.1, 0.1);
    const Pose away = poseAt(0.1, -0.1, 0.1 + CV_PI);
    const Localizer localizer(map, CAMERA);
    EXPECT_TRUE(localizer.locate(wall.image(truth), &truth).found);
    EXPECT_TRUE(localizer.locate(wall.image(truth), &away).found)
            << "it only says which keyframes come first";
}

TEST_F(Localization, bad_sources_are_told)
{
    const auto error = [&] { return messageOf([&] { buildMap(sources); }); };
    sources.depth = folder.path("images");
    EXPECT_EQ(folder.path("images/k0.png") + " is no 16-bit depth of the image's size", error());
    sources.depth = "";
    std::vector<NamedPose> elsewhere;
    for (int i = 0; i < 6; i++)
        elsewhere.push_back({"k" + std::to_string(i), poseAt(0, 0.3 * i, -0.1 * i)});
    writeTrajectory(folder.path("poses.txt"), elsewhere);
    for (const std::string& depth : {folder.path("depth"), std::string()})
    {
        sources.depth = depth;
        EXPECT_EQ(folder.path("poses.txt") + " does not fit the images in " + folder.path("images") +
                          ": are the poses those of these images, and is the camera right?",
                error());
    }
    folder.write("images/k3.png", "no image");
    EXPECT_EQ(folder.path("images/k3.png") + " cannot be read as an image", error());
    folder.write("poses.txt", "other 0 0 0 0 0 0 1\n");
    EXPECT_EQ(folder.path("poses.txt") + " has no pose for any image in " + folder.path("images"), error());
    folder.write("poses.txt", "k0 0 0 0 0 0 0 1\n");
    EXPECT_EQ("points can be triangulated between two or more keyframes only: give --depth", error());
    sources.features = "orb";
    EXPECT_EQ("features 'orb' are not one of iib, own and sift", error());
}

TEST(Depth, between_pixels_but_not_over_edges)
{
    cv::Mat depth(6, 6, CV_16U, cv::Scalar(2000));
    EXPECT_NEAR(2, depthAt(depth, {2.3f, 2.6f}), 1e-9);
    EXPECT_EQ(0, depthAt(depth, {0.5f, 3})) << "too near the border";
    for (int x = 0; x < 6; x++)  // a plane: its inverse depth is linear
        depth.col(x) = cv::Scalar(std::round(1e6 / (500 - 4 * x)));
    EXPECT_NEAR(1e3 / (500 - 4 * 2.25), depthAt(depth, {2.25f, 3}), 1e-3);
    depth.col(5) = cv::Scalar(4000);
    EXPECT_NEAR(1e3 / (500 - 4 * 2.25), depthAt(depth, {2.25f, 3}), 1e-3);
    depth.col(4) = cv::Scalar(4000);
    EXPECT_EQ(0, depthAt(depth, {2.25f, 3})) << "an edge";
    depth = cv::Scalar(2000);
    depth.at<ushort>(3, 3) = 0;
    EXPECT_EQ(0, depthAt(depth, {2.25f, 2.25f})) << "unknown";
}

TEST(Triangulate, the_point_on_all_rays)
{
    std::vector<Pose> poses(2);
    poses[1].position = {1, 0, 0};
    poses[1].rotation = Eigen::AngleAxisd(-0.3, Eigen::Vector3d::UnitY());
    const Eigen::Vector3d truth(0.3, -0.2, 4);
    Eigen::Vector3d point;
    ASSERT_TRUE(triangulate(poses, {poses[0].toCamera(truth), poses[1].toCamera(truth)}, point));
    EXPECT_LT((point - truth).norm(), 1e-9);
    EXPECT_FALSE(triangulate(poses, {-poses[0].toCamera(truth), -poses[1].toCamera(truth)}, point))
            << "behind";
    const Eigen::Vector3d far(0, 0, 4000);
    EXPECT_FALSE(triangulate(poses, {poses[0].toCamera(far), poses[1].toCamera(far)}, point)) << "parallel";
}

}  // namespace
