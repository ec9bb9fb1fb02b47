// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include <cmath>

#include "../deep_keypoints.hpp"
#include "common/test/test_folder.hpp"

namespace {
using namespace iib_tools;

//! One of the networks that networks/make_networks.py wrote.
std::string network(const std::string& name) { return IIB_TEST_NETWORKS "/" + name + ".onnx"; }

//! An image of bright dots, in the order of their brightness.
cv::Mat dots(const std::vector<cv::Point>& at)
{
    cv::Mat image(70, 100, CV_8UC1, cv::Scalar(0));
    for (size_t i = 0; i < at.size(); i++)
        image.at<uchar>(at[i]) = uchar(250 - 20 * i);
    return image;
}

void expectAt(const std::vector<cv::Point>& expected, const std::vector<cv::KeyPoint>& keypoints)
{
    ASSERT_EQ(expected.size(), keypoints.size());
    for (size_t i = 0; i < expected.size(); i++)
        EXPECT_EQ(cv::Point2f(expected[i]), keypoints[i].pt) << i;
}

const std::vector<cv::Point> DOTS = {{40, 33}, {7, 8}, {90, 60}};

// Scores: the image itself. Descriptors: the sum over cells of 8 x 8, and twice that.
TEST(DeepKeypoints, heatmap_and_descriptor_map)
{
    DeepDetector detector(network("heatmap"));
    EXPECT_TRUE(detector.hasDescriptors());
    const DeepKeypoints found = detector.detect(dots(DOTS), 10);
    expectAt(DOTS, found.keypoints);
    ASSERT_EQ(cv::Size(2, 3), found.descriptors.size());
    for (int i = 0; i < 3; i++)
    {
        EXPECT_NEAR(1 / std::sqrt(5.), found.descriptors.at<float>(i, 0), 1e-5);
        EXPECT_NEAR(2 / std::sqrt(5.), found.descriptors.at<float>(i, 1), 1e-5);
    }
    expectAt({DOTS[0], DOTS[1]}, detector.detect(dots(DOTS), 2).keypoints);
}

// Logit c is 20 times pixel c of the cell, the last is 0.
TEST(DeepKeypoints, superpoint_logits)
{
    DeepDetector detector(network("superpoint"));
    EXPECT_FALSE(detector.hasDescriptors());
    expectAt(DOTS, detector.detect(dots(DOTS), 3).keypoints);
}

// The same three points and scores for any image.
TEST(DeepKeypoints, keypoint_list_in_colour)
{
    DeepDetector detector(network("list"));
    const DeepKeypoints found = detector.detect(cv::Mat(64, 128, CV_8UC1, cv::Scalar(5)), 10);
    ASSERT_EQ(3u, found.keypoints.size());
    EXPECT_EQ(cv::Point2f(63.5f, 31.5f), found.keypoints[0].pt);
    EXPECT_EQ(cv::Point2f(95.25f, 15.75f), found.keypoints[1].pt);
    EXPECT_EQ(cv::Point2f(0, 0), found.keypoints[2].pt);
    EXPECT_NEAR(0.9, found.keypoints[0].response, 1e-3);
}

TEST(DeepKeypoints, another_network_is_refused)
{
    TestFolder folder;
    folder.write("broken.onnx", "no network");
    EXPECT_NE("", messageOf([&] { DeepDetector detector(folder.path("broken.onnx")); }));
    for (const char* name : {"five_channels", "map"})
        EXPECT_NE(std::string::npos,
                messageOf([&] { DeepDetector detector(network(name)); }).find("no keypoint network"))
                << name;
}

}  // namespace
