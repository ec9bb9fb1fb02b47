// SPDX-License-Identifier: Apache-2.0

#include "../pair_list.hpp"
#include "iib_geometry/test/test_folder.hpp"

namespace {
using namespace iib_tools;

const std::string CAMERAS = " 500. 0. 30. 0. 510. 20. 0. 0. 1. 700 0 11 0 710 12 0 0 1";
const std::string POSE = " 0.8 0. 0.6 1. 0. 1. 0. 2. -0.6 0. 0.8 3. 0. 0. 0. 1.";  // about y

TEST(PairList, two_images_with_cameras_and_pose)
{
    const TestFolder folder;
    folder.write("pairs.txt", "hall/images/a.jpg hall/other/b.png 0 3" + CAMERAS + POSE +
                                      "\r\nc.jpg d.jpg 0 0" + CAMERAS + POSE + "\n");
    const std::vector<ViewPair> pairs = readPairList(folder.path("pairs.txt"), "/data");
    ASSERT_EQ(2u, pairs.size());
    EXPECT_EQ("list pairs.txt", pairs[0].set);
    EXPECT_EQ("hall/images", pairs[0].sequence);
    EXPECT_EQ("hall/images/a.jpg hall/other/b.png", pairs[0].target);
    EXPECT_EQ("/data/hall/images/a.jpg", pairs[0].referenceFile);
    EXPECT_EQ("/data/hall/other/b.png", pairs[0].targetFile);
    EXPECT_EQ(cv::Matx33d(500, 0, 30, 0, 510, 20, 0, 0, 1), pairs[0].referenceCamera);
    EXPECT_EQ(cv::Matx33d(700, 0, 11, 0, 710, 12, 0, 0, 1), pairs[0].targetCamera);
    EXPECT_EQ(cv::Matx33d(.8, 0, .6, 0, 1, 0, -.6, 0, .8), pairs[0].rotation);
    EXPECT_EQ(cv::Vec3d(1, 2, 3), pairs[0].translation);
    EXPECT_EQ(0, pairs[0].referenceTurns);
    EXPECT_EQ(3, pairs[0].targetTurns);
    EXPECT_EQ("", pairs[1].sequence);
}

TEST(PairList, broken_lines_are_reported)
{
    const TestFolder folder;
    const std::string good = "a b 0 0" + CAMERAS + POSE, zeros = " 0 0 0 0 0 0 0 0 0";
    for (const std::string& bad : {std::string(), std::string("a b"), "a c 0 0" + CAMERAS, good + " 1",
                 "a c 4 0" + CAMERAS + POSE, "a c 0 -1" + CAMERAS + POSE, "a,b c 0 0" + CAMERAS + POSE,
                 good,                                                  // twice
                 "a c 0 0 9 1 9 0 9 9 0 0 1 9 0 9 0 9 9 0 0 1" + POSE,  // skew
                 "a c 0 0 9 0 9 0 9 9 0 0 1 9 0 9 1 9 9 0 0 1" + POSE,
                 "a c 0 0" + CAMERAS + " 1 0 0 1 0 1 0 2 0 0 1 3 0 0 0 2",
                 "a c 0 0" + zeros + zeros + POSE,                           // no camera
                 "a c 0 0" + CAMERAS + " 1 0 0 1 0 1 0 2 0 0 -1 3 0 0 0 1",  // a mirror
                 "a c 0 0" + CAMERAS + " 1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1"})  // no movement
    {
        folder.write("pairs.txt", good + "\n" + bad + "\n");
        EXPECT_NE(std::string::npos,
                messageOf([&] { readPairList(folder.path("pairs.txt"), "."); }).find("pairs.txt, line 2"))
                << bad;
    }
    EXPECT_NE(std::string::npos,
            messageOf([&] { readPairList(folder.path("none.txt"), "."); }).find("cannot be read"));
}

//! A scene point in both images, before and after they are rotated upright.
TEST(PairList, turned_images_see_what_they_saw)
{
    const cv::Size sizes[2] = {{60, 40}, {50, 70}};
    for (int turns = 0; turns < 16; turns++)
    {
        ViewPair pair = ViewPair();
        pair.referenceTurns = turns / 4;
        pair.targetTurns = turns % 4;
        pair.referenceCamera = cv::Matx33d(50, 0, 31, 0, 52, 19, 0, 0, 1);
        pair.targetCamera = cv::Matx33d(60, 0, 23, 0, 61, 34, 0, 0, 1);
        pair.rotation = cv::Matx33d(.8, 0, .6, 0, 1, 0, -.6, 0, .8);
        pair.translation = cv::Vec3d(-2, .4, 1.5);
        const cv::Vec3d point(-.1, .2, 4);
        cv::Mat images[2];
        const auto project = [&](int which, const cv::Vec3d& inReference) {
            const cv::Vec3d p = which ? pair.targetCamera * (pair.rotation * inReference + pair.translation)
                                      : pair.referenceCamera * inReference;
            return cv::Point(cvRound(p[0] / p[2]), cvRound(p[1] / p[2]));
        };
        for (int which : {0, 1})
        {
            images[which] = cv::Mat(sizes[which], CV_8U, cv::Scalar(0));
            images[which].at<uchar>(project(which, point)) = 255;
        }
        turnUpright(pair, images[0], images[1]);
        EXPECT_EQ(turns / 4 % 2 ? 40 : 60, images[0].cols);
        cv::Vec3d moved = point;  // in the axes of the first camera, which was rotated
        for (int i = 0; i < turns / 4; i++)
            moved = cv::Vec3d(moved[1], -moved[0], moved[2]);
        for (int which : {0, 1})
            EXPECT_EQ(255, images[which].at<uchar>(project(which, moved))) << turns << " " << which;
    }
}

}  // namespace
