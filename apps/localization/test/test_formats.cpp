// SPDX-License-Identifier: Apache-2.0

#include "../src/colmap_model.hpp"
#include "../src/trajectory.hpp"
#include "common/test/test_folder.hpp"

namespace {
using namespace iib_localization;

std::string textOf(const std::string& path)
{
    std::ifstream stream(path);
    return {std::istreambuf_iterator<char>(stream), {}};
}

TEST(Cameras, round_trip_and_centres_of_pixels)
{
    const TestFolder folder;
    const std::string text = "# CAMERA_ID, MODEL, WIDTH, HEIGHT, PARAMS[]\n"
                             "1 PINHOLE 640 480 518.4 519.5 320 240\n"
                             "2 SIMPLE_RADIAL 640 480 500 320 240 -0.1\n"
                             "7 OPENCV 768 512 690 691 380.8 252.25 -0.2 0.05 0.001 -0.002\n";
    folder.write("cameras.txt", text);
    const Cameras cameras = readCameras(folder.path("cameras.txt"));
    writeCameras(folder.path("again.txt"), cameras);
    EXPECT_EQ(text, textOf(folder.path("again.txt")));
    EXPECT_EQ(319.5, cameras.at(1).pinhole().cx);
    EXPECT_EQ(519.5, cameras.at(1).pinhole().fy);
    EXPECT_EQ(239.5, cameras.at(2).pinhole().cy);
}

TEST(Cameras, undistorting_undoes_the_distortion)
{
    Camera camera{"SIMPLE_RADIAL", {640, 480}, {500, 320.5, 240.5, -0.1}};
    // by COLMAP's definition: (u, v) at depth 1 is seen at f (1 + k r^2) (u, v) + c
    const double u = 0.4, v = -0.3, d = 500 * (1 - 0.1 * 0.25);
    const Eigen::Vector2d seen(d * u + 320, d * v + 240);
    EXPECT_LT((camera.distorted({500 * u + 320, 500 * v + 240}) - seen).norm(), 1e-9);
    camera.model = "OPENCV";
    camera.parameters = {690, 691, 380.8, 252.25, -0.2, 0.05, 0.001, -0.002};
    for (const cv::Point2f& p : {cv::Point2f(10, 20), cv::Point2f(700, 500), cv::Point2f(380, 250)})
    {
        const Eigen::Vector2d back = camera.distorted(camera.undistorted({p})[0]);
        EXPECT_NEAR(p.x, back.x(), 0.02);
        EXPECT_NEAR(p.y, back.y(), 0.02);
    }
}

TEST(Cameras, refuses_what_it_does_not_know)
{
    const TestFolder folder;
    const auto error = [&](const std::string& text) {
        folder.write("c", text);
        return messageOf([&] { readCameras(folder.path("c")); });
    };
    EXPECT_EQ(folder.path("c") + ":2: camera model FISHEYE is not one of PINHOLE, SIMPLE_RADIAL and OPENCV",
            error("#\n1 FISHEYE 64 48 1 1 1 1\n"));
    EXPECT_EQ(folder.path("c") + ":1: PINHOLE has 4 parameters, not 3", error("1 PINHOLE 64 48 1 1 1\n"));
    EXPECT_EQ(folder.path("c") + ":1: 'nan' is no number", error("1 PINHOLE 64 48 nan 1 1 1\n"));
    EXPECT_EQ(folder.path("c") + ":1: a focal length must be positive", error("1 PINHOLE 64 48 0 1 1 1\n"));
    EXPECT_EQ(folder.path("c") + ":2: a second camera 1",
            error("1 PINHOLE 64 48 1 1 1 1\n1 PINHOLE 6 4 1 1 1 1\n"));
    EXPECT_EQ(folder.path("c") + " has no camera", error("# none\n"));
    EXPECT_EQ(
            folder.path("none") + " cannot be opened", messageOf([&] { readCameras(folder.path("none")); }));
}

TEST(Trajectory, round_trip)
{
    const TestFolder folder;
    const std::string text =
            "# name tx ty tz qx qy qz qw\n0001 1.5 -2 0.1 0 0.6 0 0.8\n1.500000 0 0 0 0 0 0 1\n";
    folder.write("poses.txt", text);
    const std::vector<NamedPose> poses = readTrajectory(folder.path("poses.txt"));
    writeTrajectory(folder.path("again.txt"), poses);
    EXPECT_EQ(text, textOf(folder.path("again.txt")));
    // camera to world: turned about y by twice the angle whose sine is 0.6
    EXPECT_LT((poses[0].pose.toWorld({0, 0, 1}) - Eigen::Vector3d(1.5 + 0.96, -2, 0.1 + 0.28)).norm(), 1e-12);
    EXPECT_LT(
            (poses[0].pose.toCamera({1.5 + 0.96, -2, 0.1 + 0.28}) - Eigen::Vector3d(0, 0, 1)).norm(), 1e-12);

    folder.write("short.txt", "a 1 2 3 0 0 0\n");
    EXPECT_EQ(folder.path("short.txt") + ":1: 7 values, not name tx ty tz qx qy qz qw",
            messageOf([&] { readTrajectory(folder.path("short.txt")); }));
    folder.write("long.txt", "a 1 2 3 1 1 0 0\n");
    EXPECT_EQ(folder.path("long.txt") + ":1: the quaternion's length is not 1",
            messageOf([&] { readTrajectory(folder.path("long.txt")); }));
}

TEST(Trajectory, names_that_are_times)
{
    EXPECT_EQ(1500000000, *nanoseconds("01.500000"));
    EXPECT_EQ(1403636579763555584, *nanoseconds("1403636579763555584"));
    EXPECT_EQ(1403636579763555584, *nanoseconds("1403636579.763555584"));
    EXPECT_EQ(3000000000, *nanoseconds("0003"));
    EXPECT_FALSE(nanoseconds("left_0003"));
    EXPECT_FALSE(nanoseconds("9999999999999999999"));
    EXPECT_FALSE(nanoseconds(""));
    std::vector<NamedPose> poses(2);
    poses[0].name = "1403636579.763555";
    poses[1].name = "left";
    EXPECT_EQ(&poses[0].pose, findPose(poses, "1403636579763555584"));
    EXPECT_EQ(&poses[1].pose, findPose(poses, "left"));
    EXPECT_EQ(nullptr, findPose(poses, "1403636579763560000"));
}

TEST(Imu, reads_euroc)
{
    const TestFolder folder;
    folder.write("imu.csv", "#timestamp [ns],w_x\n0,0.1,-0.2,0.3,1,2,9.81\r\n5000000,0,0,0,1e-3,0,0\n");
    const std::vector<ImuReading> readings = readImu(folder.path("imu.csv"));
    ASSERT_EQ(2u, readings.size());
    EXPECT_EQ(5000000, readings[1].nanoseconds);
    EXPECT_EQ(Eigen::Vector3d(0.1, -0.2, 0.3), readings[0].rate);
    EXPECT_EQ(Eigen::Vector3d(1, 2, 9.81), readings[0].force);
    folder.write("back.csv", "5,0,0,0,0,0,0\n5,0,0,0,0,0,0\n");
    EXPECT_EQ(folder.path("back.csv") + ":2: the time does not rise",
            messageOf([&] { readImu(folder.path("back.csv")); }));
    folder.write("gap.csv", "5,0,0,,0,0,0\n");
    EXPECT_EQ(folder.path("gap.csv") + ":1: '' is no number",
            messageOf([&] { readImu(folder.path("gap.csv")); }));
}

TEST(ColmapModel, round_trip)
{
    const TestFolder folder;
    Model model;
    model.cameras[3] = {"PINHOLE", {640, 480}, {500, 500, 320, 240}};
    Keyframe k;
    k.name = "a.png";
    k.camera = 3;
    k.pose.rotation = Eigen::Quaterniond(0.8, 0, 0.6, 0);
    k.pose.position = {1, 2, 3};
    k.pixels = {{10.25, 20}, {639, 479}};
    k.points = {1, 0};
    model.keyframes = {k, Keyframe()};
    model.keyframes[1].name = "empty.png";
    model.keyframes[1].camera = 3;
    model.points = {{0.1, 0.2, 5}, {-1, 0, 7}};
    writeModel(folder.path("."), model);
    const Model back = readModel(folder.path("."));
    ASSERT_EQ(2u, back.keyframes.size());
    EXPECT_EQ("a.png", back.keyframes[0].name);
    EXPECT_EQ("empty.png", back.keyframes[1].name);
    EXPECT_EQ(3, back.keyframes[0].camera);
    EXPECT_LT((back.keyframes[0].pose.position - k.pose.position).norm(), 1e-12);
    EXPECT_LT(back.keyframes[0].pose.rotation.angularDistance(k.pose.rotation), 1e-7);
    EXPECT_EQ(k.pixels, back.keyframes[0].pixels);
    EXPECT_EQ(k.points, back.keyframes[0].points);
    EXPECT_EQ(model.points, back.points);
}

TEST(ColmapModel, reads_colmaps_own_conventions)
{
    const TestFolder folder;
    folder.write("cameras.txt", "1 PINHOLE 640 480 500 500 320 240\n");
    // a camera at (0, 0, -4) that looks along z: world to camera adds 4 to z
    folder.write("images.txt", "# comment\n2 1 0 0 0 0 0 4 1 b.png\n320.5 240.5 77 1 1 -1\n");
    folder.write("points3D.txt", "77 0 0 1 255 255 255 0.5 2 0\n");
    const Model model = readModel(folder.path("."));
    EXPECT_EQ(Eigen::Vector3d(0, 0, -4), model.keyframes[0].pose.position);
    ASSERT_EQ(1u, model.keyframes[0].pixels.size());
    EXPECT_EQ(Eigen::Vector2d(320, 240), model.keyframes[0].pixels[0]);
    EXPECT_EQ(0, model.keyframes[0].points[0]);

    folder.write("images.txt", "2 1 0 0 0 0 0 4 1 b.png\n1 1 78\n");
    EXPECT_EQ(folder.path("./images.txt") + ":2: points3D.txt has no point 78",
            messageOf([&] { readModel(folder.path(".")); }));
    folder.write("images.txt", "2 1 0 0 0 0 0 4 9 b.png\n\n");
    EXPECT_EQ(folder.path("./images.txt") + ":1: cameras.txt has no camera 9",
            messageOf([&] { readModel(folder.path(".")); }));
}

}  // namespace
