// SPDX-License-Identifier: Apache-2.0

#include "../dataset.hpp"
#include "opencv2/imgcodecs.hpp"
#include "iib_geometry/test/test_folder.hpp"

namespace {
using namespace iib_tools;

const char* const SHIFT = "1 0 5\n0 1 -2\n0 0 1\n";

void writeImages(const TestFolder& folder, const std::vector<std::string>& names)
{
    for (const std::string& name : names)
    {
        const int type = name.find(".ppm") != std::string::npos ? CV_8UC3 : CV_8UC1;
        ASSERT_TRUE(cv::imwrite(folder.path(name), cv::Mat(20, 30, type, cv::Scalar::all(100))));
    }
}

TEST(Dataset, numbered_images_with_homographies)
{
    TestFolder folder;
    folder.makeFolder("set/v_scene");
    writeImages(folder, {"set/v_scene/1.ppm", "set/v_scene/2.ppm", "set/v_scene/10.ppm"});
    folder.write("set/v_scene/H_1_2", SHIFT);
    folder.write("set/v_scene/H_1_10", SHIFT);

    const std::vector<ImagePair> pairs = findPairs({folder.path("")});
    ASSERT_EQ(2u, pairs.size());
    EXPECT_EQ("set/v_scene/2", pairs[0].name());
    EXPECT_EQ("set/v_scene/10", pairs[1].name());
    EXPECT_EQ("viewpoint", pairs[0].kind);
    const LoadedPair loaded = loadPair(pairs[0]);
    EXPECT_EQ(5, loaded.homography(0, 2));
    EXPECT_EQ(-2, loaded.homography(1, 2));
    EXPECT_EQ(cv::Size(30, 20), loaded.target.size());
}

TEST(Dataset, static_camera_with_extra_maps)
{
    TestFolder folder;
    folder.makeFolder("room/depth");
    writeImages(folder, {"room/1.png", "room/2.png", "room/depth/1.png", "room/depth/2.png"});
    std::vector<ImagePair> pairs = findPairs({folder.path("")});
    ASSERT_EQ(1u, pairs.size());
    EXPECT_EQ("light", pairs[0].kind);
    EXPECT_EQ(std::vector<std::string>({"depth"}), pairs[0].extraNames);
    const LoadedPair loaded = loadPair(pairs[0]);
    EXPECT_EQ(0, cv::norm(loaded.homography - cv::Matx33d::eye()));
    EXPECT_EQ(1u, loaded.targetExtra.size());

    cv::imwrite(folder.path("room/depth/2.png"), cv::Mat(5, 5, CV_8UC1, cv::Scalar(0)));
    EXPECT_NE(std::string::npos, messageOf([&] { loadPair(pairs[0]); }).find("depth/2.png"));
}

TEST(Dataset, original_oxford_layout)
{
    TestFolder folder;
    folder.makeFolder("boat");
    writeImages(folder, {"boat/img1.pgm", "boat/img2.pgm"});
    folder.write("boat/H1to2p", SHIFT);
    const std::vector<ImagePair> pairs = findPairs({folder.path("")});
    ASSERT_EQ(1u, pairs.size());
    EXPECT_EQ("zoom", pairs[0].kind);
    EXPECT_EQ(5, loadPair(pairs[0]).homography(0, 2));
}

TEST(Dataset, broken_files_are_named)
{
    TestFolder folder;
    folder.makeFolder("s");
    writeImages(folder, {"s/1.png", "s/3.png"});
    folder.write("s/2.png", "no image");
    folder.write("s/H_1_2", SHIFT);
    const std::vector<ImagePair> pairs = findPairs({folder.path("")});
    ASSERT_EQ(2u, pairs.size());
    EXPECT_NE(std::string::npos, messageOf([&] { loadPair(pairs[0]); }).find("2.png: not a readable image"));
    EXPECT_NE(std::string::npos, messageOf([&] { loadPair(pairs[1]); }).find("H_1_3: cannot be read"));
    EXPECT_NE(std::string::npos,
            messageOf([&] { findPairs({folder.path("s/1.png")}); }).find("no such folder"));
}

TEST(Dataset, homography_files)
{
    TestFolder folder;
    const struct
    {
        const char* text;
        bool good;
    } cases[] = {{SHIFT, true}, {"1 0 0 0 1 0 0 0", false}, {"1 0 0 0 1 0 0 0 1 7", false},
            {"1 0 0 0 x 0 0 0 1", false}, {"nan 0 0 0 1 0 0 0 1", false}, {"1 2 3 2 4 6 0 0 1", false},
            {"0 0 0 0 0 0 0 0 0", false}, {"", false}, {"0.05 0 4000 0 0.05 4000 0 0 1", true}};
    for (const auto& c : cases)
    {
        folder.write("H", c.text);
        EXPECT_EQ(c.good, messageOf([&] { readHomography(folder.path("H")); }).empty()) << c.text;
    }
}

}  // namespace
