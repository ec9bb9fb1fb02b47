// SPDX-License-Identifier: Apache-2.0

#include "../keypoints.hpp"
#include "opencv2/imgproc.hpp"
#include "iib_geometry/test/test_folder.hpp"

namespace {
using namespace iib_tools;

TEST(Keypoints, sampled_uniformly_over_the_list)
{
    std::vector<cv::KeyPoint> list;
    for (int i = 0; i < 10; i++)
        list.push_back(cv::KeyPoint(float(i), 0, 1));
    const std::vector<cv::KeyPoint> four = sampleUniformly(list, 4);
    ASSERT_EQ(4u, four.size());
    const float expected[] = {0, 2, 5, 7};
    for (int i = 0; i < 4; i++)
        EXPECT_EQ(expected[i], four[i].pt.x);
    EXPECT_EQ(10u, sampleUniformly(list, 11).size());
}

TEST(Keypoints, seeds_lie_inside_both_images)
{
    const std::vector<cv::KeyPoint> corners = {cv::KeyPoint(31, 50, 64), cv::KeyPoint(32, 50, 64, -1, 3),
            cv::KeyPoint(50, 50, 64, -1, 2), cv::KeyPoint(68, 50, 64, -1, 1), cv::KeyPoint(69, 50, 64)};
    const cv::Matx33d shift(1, 0, 10, 0, 1, 0, 0, 0, 1);
    const cv::Size size(100, 100);
    SeedPoints seeds = projectSeeds(corners, cv::Matx33d::eye(), size, size, 32, 100);
    EXPECT_EQ(3u, seeds.reference.size());
    seeds = projectSeeds(corners, shift, size, size, 32, 100);
    ASSERT_EQ(2u, seeds.reference.size());
    EXPECT_EQ(42, seeds.target[0].pt.x);
    EXPECT_EQ(32, seeds.reference[0].pt.x);
    EXPECT_EQ(1, seeds.target[1].response);
    EXPECT_EQ(-1, seeds.target[1].angle);
    EXPECT_EQ(64, seeds.target[1].size);
}

TEST(Keypoints, dark_images_give_corners_of_a_lower_threshold)
{
    cv::Mat bright(200, 200, CV_8UC1);
    cv::randu(bright, 0, 256);
    const cv::Mat dark = bright / 16;  // differences are at most 15
    const std::vector<cv::KeyPoint> many = fastCorners(bright, 32, 50);
    EXPECT_GE(many.size(), 50u);
    for (const cv::KeyPoint& k : many)
        ASSERT_GE(k.response, 20);
    const std::vector<cv::KeyPoint> few = fastCorners(dark, 32, 50);
    const auto inside = std::count_if(few.begin(), few.end(), [](const cv::KeyPoint& k) {
        return k.pt.x >= 32 && k.pt.y >= 32 && k.pt.x <= 168 && k.pt.y <= 168;
    });
    EXPECT_GE(inside, 50);
    EXPECT_TRUE(fastCorners(cv::Mat::zeros(99, 99, CV_8UC1), 32, 1).empty());
}

TEST(Keypoints, centroid_angle_turns_with_the_image)
{
    cv::Mat image(101, 101, CV_8UC1, cv::Scalar(0));
    image.colRange(60, 101).setTo(200);
    std::vector<cv::KeyPoint> centre(1, cv::KeyPoint(50, 50, 64));
    orientByCentroid(image, 32, centre);
    EXPECT_NEAR(0, std::remainder(centre[0].angle, 360.f), 0.5);
    cv::Mat turned;
    cv::rotate(image, turned, cv::ROTATE_90_CLOCKWISE);
    orientByCentroid(turned, 32, centre);
    EXPECT_NEAR(90, centre[0].angle, 0.5);
}

TEST(Keypoints, read_from_a_file)
{
    TestFolder folder;
    std::vector<cv::KeyPoint> keypoints;
    cv::Mat descriptors;
    folder.write("k.csv", "x,y,size,angle,response\n1.5,2,7,90,0.5\r\n3,4,8,-1,0\n");
    readKeypoints(folder.path("k.csv"), keypoints, descriptors);
    ASSERT_EQ(2u, keypoints.size());
    EXPECT_EQ(1.5f, keypoints[0].pt.x);
    EXPECT_EQ(7, keypoints[0].size);
    EXPECT_EQ(0.5f, keypoints[0].response);
    EXPECT_EQ(-1, keypoints[1].angle);
    EXPECT_TRUE(descriptors.empty());
    folder.write("k.csv", "1,2,3,-1,0,.5,.25\n1,2,3,-1,0,-1,2\n");
    readKeypoints(folder.path("k.csv"), keypoints, descriptors);
    EXPECT_EQ(0, cvtest::norm(descriptors, cv::Mat(cv::Matx22f(.5f, .25f, -1, 2)), cv::NORM_INF));
    for (const char* line :
            {"1", "1,2,0,-1,0,1", "1,2,nan,0,0,1", "a,b,c", "1,2,3,-1,0", "1,2,3,-1,0,1,2", "1;2;3"})
    {
        folder.write("k.csv", std::string("1,2,3,-1,0,5\n") + line + "\n");
        EXPECT_NE(std::string::npos, messageOf([&] {
            readKeypoints(folder.path("k.csv"), keypoints, descriptors);
        }).find("line 2"))
                << line;
    }
    EXPECT_NE("", messageOf([&] { readKeypoints(folder.path("missing"), keypoints, descriptors); }));
}

}  // namespace
