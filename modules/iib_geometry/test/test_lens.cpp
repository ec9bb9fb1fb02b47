// SPDX-License-Identifier: Apache-2.0

#include "lens.hpp"
#include "pose.hpp"
#include "wall.hpp"

namespace {
using namespace iib_localization;

TEST(Lens, of_colmaps_definitions)
{
    // a point at (u, v) at depth 1, and where COLMAP's equations have it
    const double u = 0.4, v = -0.3, r2 = 0.25, angle = std::atan(0.5), radial = 1 - 0.1 * r2 + 0.05 * r2 * r2;
    const double fisheye = angle / 0.5 * (1 + 0.02 * std::pow(angle, 2) - 0.01 * std::pow(angle, 8));
    const struct
    {
        const char* camera;
        cv::Point2d seen;
    } cases[] = {{"SIMPLE_PINHOLE,640,480,500,320.5,240.5", {500 * u + 320, 500 * v + 240}},
            {"PINHOLE,640,480,500,510,320.5,240.5", {500 * u + 320, 510 * v + 240}},
            {"SIMPLE_RADIAL,640,480,500,320.5,240.5,-0.1", {500 * 0.975 * u + 320, 500 * 0.975 * v + 240}},
            {"RADIAL,640,480,500,320.5,240.5,-0.1,0.05", {500 * radial * u + 320, 500 * radial * v + 240}},
            {"OPENCV,640,480,500,510,320.5,240.5,-0.1,0.05,0.001,-0.002",
                    {500 * (radial * u + 2 * 0.001 * u * v - 0.002 * (r2 + 2 * u * u)) + 320,
                            510 * (radial * v + 0.001 * (r2 + 2 * v * v) - 2 * 0.002 * u * v) + 240}},
            {"OPENCV_FISHEYE,640,480,500,510,320.5,240.5,0.02,0,0,-0.01",
                    {500 * fisheye * u + 320, 510 * fisheye * v + 240}}};
    for (const auto& c : cases)
    {
        const Lens lens(Camera::parse(c.camera));
        const cv::Point2d seen = lens.project({{2 * u, 2 * v, 2}})[0];
        EXPECT_LT(cv::norm(seen - c.seen), 1e-9) << c.camera;
        const cv::Vec3d straight = lens.matrix() * cv::Vec3d(u, v, 1);
        EXPECT_LT(cv::norm(lens.undistorted({seen})[0] - cv::Point2d(straight[0], straight[1])), 1e-2)
                << c.camera;
        EXPECT_TRUE(std::isnan(lens.project({{0, 0, -1}})[0].x)) << "behind";
    }
}

TEST(Lens, cameras_that_are_none)
{
    const auto error = [](const char* text) { return messageOf([&] { Camera::parse(text); }); };
    EXPECT_EQ("camera PINHOLE,640,480 is not MODEL,WIDTH,HEIGHT,PARAMETERS", error("PINHOLE,640,480"));
    for (const char* text :
            {"", "PINHOLE", "PINHOLE,", "PINHOLE,640,480,1,", "PINHOLE,640,480,1 ,1", "PINHOLE,-1e99,1,1"})
        EXPECT_EQ(std::string("camera ") + text + " is not MODEL,WIDTH,HEIGHT,PARAMETERS", error(text));
    EXPECT_EQ("camera PINHOLE,640,4e9,1,1,1,1 is not MODEL,WIDTH,HEIGHT,PARAMETERS",
            error("PINHOLE,640,4e9,1,1,1,1"));
    EXPECT_EQ("camera PINHOLE,640,480,x,1,1,1 is not MODEL,WIDTH,HEIGHT,PARAMETERS",
            error("PINHOLE,640,480,x,1,1,1"));
    EXPECT_EQ("camera model PINHOLE has 4 parameters, not 3", error("PINHOLE,640,480,1,1,1"));
    EXPECT_EQ("a camera's size and focal length must be positive", error("PINHOLE,640,480,1,0,1,1"));
    EXPECT_EQ("a camera's size and focal length must be positive", error("RADIAL,0,480,1,1,1,0,0"));
    EXPECT_EQ(0u,
            error("FOV,640,480,1,1,1,1,1").find("camera model FOV is not one of SIMPLE_PINHOLE, PINHOLE"));
}

TEST(Pose, refined_to_the_truth_among_wrong_matches)
{
    cv::RNG random(3);
    for (const char* text :
            {"PINHOLE,640,480,500,510,320,240", "OPENCV,640,480,500,510,320,240,-0.1,0.05,0.001,-0.002",
                    "OPENCV_FISHEYE,640,480,400,410,320,240,0.02,0,0,-0.01"})
    {
        const Lens lens(Camera::parse(text));
        const cv::Affine3d truth(cv::Vec3d(0.1, 0.3, -0.2), cv::Vec3d(0.5, -1, 2));
        std::vector<Match> matches;
        for (int i = 0; i < 200; i++)
        {
            const cv::Point3d seen(
                    random.uniform(-2., 2.), random.uniform(-1.5, 1.5), random.uniform(4., 9.));
            const cv::Point2d wrong(random.uniform(-30., 30.), random.uniform(-30., 30.));
            matches.push_back(
                    {lens.project({seen})[0] + (i % 4 == 0 ? wrong : cv::Point2d()), truth.inv() * seen});
        }
        cv::Affine3d pose;
        ASSERT_TRUE(poseByRansac(matches, lens, 4, pose));
        cv::Matx66d covariance;
        ASSERT_TRUE(refinePose(matches, lens, pose, covariance));
        EXPECT_LT(cv::norm((pose * truth.inv()).translation()), 0.01) << text;
        EXPECT_LT(cv::norm((pose * truth.inv()).rvec()), 0.002) << text;
    }
}

}  // namespace
