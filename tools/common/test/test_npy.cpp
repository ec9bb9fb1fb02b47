// SPDX-License-Identifier: Apache-2.0

#include "../npy.hpp"
#include "npy_text.hpp"
#include "test_folder.hpp"

namespace {
using namespace iib_tools;

TEST(Npy, floats_and_bytes)
{
    TestFolder folder;
    const cv::Mat floats = (cv::Mat_<float>(2, 3) << 1, -2, 3.5f, 4, 5, 1e-9f);
    const cv::Mat bytes = (cv::Mat_<uchar>(1, 2) << 255, 7);
    for (int version : {1, 2})
        for (const cv::Mat& expected : {floats, bytes})
        {
            folder.write("a.npy", npyText(expected, version));
            const cv::Mat found = readNpy(folder.path("a.npy"));
            ASSERT_EQ(expected.type(), found.type());
            ASSERT_EQ(expected.size(), found.size());
            EXPECT_EQ(0, cv::norm(expected, found, cv::NORM_INF));
        }
}

TEST(Npy, anything_else_is_told)
{
    TestFolder folder;
    const auto refused = [&](const std::string& text) {
        folder.write("a.npy", text);
        return messageOf([&] { readNpy(folder.path("a.npy")); }).find("a.npy: ") != std::string::npos;
    };
    const std::string good = npyText(cv::Mat::zeros(2, 3, CV_32F));
    EXPECT_FALSE(refused(good));
    EXPECT_TRUE(refused(""));
    EXPECT_TRUE(refused("x,y\n1,2\n"));
    for (size_t size = 1; size < good.size(); size++)
        EXPECT_TRUE(refused(good.substr(0, size))) << size;
    EXPECT_TRUE(refused(good + "more"));
    const auto with = [&](const std::string& from, const std::string& to) {
        return std::string(good).replace(good.find(from), from.size(), to);
    };
    EXPECT_TRUE(refused(with("<f4", ">f4")));
    EXPECT_TRUE(refused(with("<f4", "<f8")));
    EXPECT_TRUE(refused(with("False", "True ")));
    EXPECT_TRUE(refused(with("(2, 3)", "(6,)  ")));
    EXPECT_TRUE(refused(with("(2, 3)", "(2, 9)")));
    EXPECT_TRUE(refused(with("(2, 3)", "(-2,3)")));
    EXPECT_NE("", messageOf([&] { readNpy(folder.path("none.npy")); }));
}

}  // namespace
