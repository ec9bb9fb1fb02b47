// SPDX-License-Identifier: Apache-2.0

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

TEST(DeepKeypoints, two_sizes_in_a_row)
{
    for (const char* name : {"heatmap", "superpoint"})
    {
        DeepDetector detector(network(name));
        for (const cv::Size size : {cv::Size(100, 70), cv::Size(200, 130), cv::Size(100, 70)})
        {
            cv::Mat image(size, CV_8U, cv::Scalar(0));
            dots(DOTS).copyTo(image(cv::Rect(0, 0, 100, 70)));
            expectAt(DOTS, detector.detect(image, 3).keypoints);
        }
    }
}

TEST(DeepKeypoints, border_is_left_out)
{
    const std::vector<cv::Point> at = {
            {50, 3}, {3, 30}, {96, 40}, {60, 66}, {50, 30}, {95, 10}, {4, 60}, {20, 65}};
    expectAt(std::vector<cv::Point>(at.begin() + 4, at.end()),
            DeepDetector(network("superpoint")).detect(dots(at), 4).keypoints);
}

// The brightest suppresses the second, which then does not suppress the third.
TEST(DeepKeypoints, suppression_is_repeated)
{
    const std::vector<cv::Point> chain = {{40, 30}, {43, 30}, {46, 30}};
    expectAt({chain[0], chain[2]}, DeepDetector(network("superpoint")).detect(dots(chain), 2).keypoints);
    const std::vector<cv::Point> near = {{40, 30}, {42, 30}, {44, 30}};
    const DeepKeypoints found = DeepDetector(network("heatmap")).detect(dots(near), 2);
    ASSERT_EQ(2u, found.keypoints.size());
    const double weight = std::exp(20 / 255. / 0.1);  // of the second, which pulls the third
    EXPECT_NEAR(44 - 2 * weight / (1 + weight), found.keypoints[1].pt.x, 0.02);
}

// A step towards a neighbour that is nearly as bright, by the weights of a softmax.
TEST(DeepKeypoints, maximum_is_refined)
{
    const DeepKeypoints found =
            DeepDetector(network("heatmap")).detect(dots({{40, 30}, {41, 30}}), 1);  // 250 and 230
    ASSERT_EQ(1u, found.keypoints.size());
    const double weight = std::exp(-20 / 255. / 0.1), rest = 23 * std::exp(-250 / 255. / 0.1);
    EXPECT_NEAR(40 + weight / (1 + weight + rest), found.keypoints[0].pt.x, 0.01);
    EXPECT_NEAR(30, found.keypoints[0].pt.y, 0.001);
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
