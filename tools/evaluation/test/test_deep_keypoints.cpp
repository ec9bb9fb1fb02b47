// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include <cmath>

#include "../deep_keypoints.hpp"
#include "onnx_writer.hpp"
#include "common/test/test_folder.hpp"

namespace {
using namespace iib_tools;

//! A convolution of the network's input.
std::string convolution(const std::string& name, const std::string& weights, int kernel, int stride, int pad)
{
    return onnx::node("Conv", {"image", weights}, name,
            {onnx::integers("kernel_shape", {kernel, kernel}), onnx::integers("strides", {stride, stride}),
                    onnx::integers("pads", {pad, pad, pad, pad})});
}

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

TEST(DeepKeypoints, heatmap_and_descriptor_map)
{
    TestFolder folder;
    // Scores: the image itself. Descriptors: the sum over cells of 8 x 8, and twice that.
    std::vector<float> sums(2 * 64, 1.f);
    std::fill(sums.begin() + 64, sums.end(), 2.f);
    folder.write("heat.onnx",
            onnx::model({convolution("scores", "one", 1, 1, 0), convolution("map", "sums", 8, 8, 0)},
                    {onnx::tensor("one", {1, 1, 1, 1}, {1}), onnx::tensor("sums", {2, 1, 8, 8}, sums)},
                    onnx::value("image", {1, 1, 64, 64}),
                    {onnx::value("scores", {1, 1, 64, 64}), onnx::value("map", {1, 2, 8, 8})}));
    DeepDetector detector(folder.path("heat.onnx"));
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

TEST(DeepKeypoints, superpoint_logits)
{
    TestFolder folder;
    // Logit c is 20 times pixel c of the cell, the last is 0.
    std::vector<float> pick(65 * 64, 0.f);
    for (int c = 0; c < 64; c++)
        pick[c * 64 + c] = 20.f;
    folder.write("super.onnx",
            onnx::model({convolution("semi", "pick", 8, 8, 0)}, {onnx::tensor("pick", {65, 1, 8, 8}, pick)},
                    onnx::value("image", {1, 1, 64, 64}), {onnx::value("semi", {1, 65, 8, 8})}));
    DeepDetector detector(folder.path("super.onnx"));
    EXPECT_FALSE(detector.hasDescriptors());
    expectAt(DOTS, detector.detect(dots(DOTS), 3).keypoints);
}

TEST(DeepKeypoints, keypoint_list_in_colour)
{
    TestFolder folder;
    // Convolutions of three channels with zero weights leave their biases: the points and their scores.
    const auto list = [](const std::string& name, const std::string& bias, const std::string& shape) {
        return std::vector<std::string>({onnx::node("Conv", {"image", bias + "_weights", bias},
                                                 name + "_conv", {onnx::integers("kernel_shape", {1, 1})}),
                onnx::node("GlobalAveragePool", {name + "_conv"}, name + "_mean", {}),
                onnx::node("Reshape", {name + "_mean", shape}, name, {})});
    };
    std::vector<std::string> nodes = list("keypoints", "points", "three_by_two");
    for (const std::string& n : list("confidence", "scores", "three_by_one"))
        nodes.push_back(n);
    const auto zeros = [](const std::string& name, int outputs) {
        return onnx::tensor(name, {outputs, 3, 1, 1}, std::vector<float>(size_t(outputs) * 3, 0.f));
    };
    folder.write("list.onnx",
            onnx::model(nodes,
                    {zeros("points_weights", 6), zeros("scores_weights", 3),
                            onnx::tensor("points", {6}, {-1, -1, 0, 0, 0.5f, -0.5f}),
                            onnx::tensor("scores", {3}, {0.1f, 0.9f, 0.5f}),
                            onnx::shape("three_by_two", 3, 2), onnx::shape("three_by_one", 3, 1)},
                    onnx::value("image", {1, 3, 64, 64}),
                    {onnx::value("keypoints", {3, 2}), onnx::value("confidence", {3, 1})}));
    DeepDetector detector(folder.path("list.onnx"));
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
    folder.write("five.onnx",
            onnx::model({convolution("features", "w", 1, 1, 0)},
                    {onnx::tensor("w", {1, 5, 1, 1}, std::vector<float>(5, 1.f))},
                    onnx::value("image", {1, 5, 8, 8}), {onnx::value("features", {1, 1, 8, 8})}));
    EXPECT_NE(std::string::npos,
            messageOf([&] { DeepDetector detector(folder.path("five.onnx")); }).find("no keypoint network"));
    folder.write(
            "map.onnx", onnx::model({convolution("map", "w", 8, 8, 0)},
                                {onnx::tensor("w", {2, 1, 8, 8}, std::vector<float>(128, 1.f))},
                                onnx::value("image", {1, 1, 64, 64}), {onnx::value("map", {1, 2, 8, 8})}));
    EXPECT_NE(std::string::npos,
            messageOf([&] { DeepDetector detector(folder.path("map.onnx")); }).find("no keypoint network"));
}

}  // namespace
