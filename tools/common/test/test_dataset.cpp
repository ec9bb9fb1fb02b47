// SPDX-License-Identifier: Apache-2.0

#include "../dataset.hpp"
#include "opencv2/imgcodecs.hpp"
#include "test_folder.hpp"

namespace {
using namespace iib_tools;

const char* const SHIFT = "1 0 5\n0 1 -2\n0 0 1\n";

void writeImage(const TestFolder& folder, const std::string& name)
{
    const int type = name.find(".ppm") != std::string::npos ? CV_8UC3 : CV_8UC1;
    ASSERT_TRUE(cv::imwrite(folder.path(name), cv::Mat(20, 30, type, cv::Scalar::all(100))));
}

TEST(Dataset, numbered_images_with_homographies)
{
    TestFolder folder;
    folder.makeFolder("set/v_scene");
    for (const char* name : {"1.ppm", "2.ppm", "10.ppm"})
        writeImage(folder, std::string("set/v_scene/") + name);
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

TEST(Dataset, correspondences_instead_of_a_homography)
{
    TestFolder folder;
    folder.makeFolder("wxbs/kremlin");
    for (const char* name : {"wxbs/kremlin/01.png", "wxbs/kremlin/02.png"})
        writeImage(folder, name);
    folder.write("wxbs/kremlin/corrs.txt", "1 2 3 4\n\n5.5 6 7 8\r\n");
    const std::vector<ImagePair> pairs = findPairs({folder.path("")});
    ASSERT_EQ(1u, pairs.size());
    EXPECT_EQ("wide", pairs[0].kind);
    EXPECT_EQ(std::vector<cv::Vec4d>({{1, 2, 3, 4}, {5.5, 6, 7, 8}}), loadPair(pairs[0]).correspondences);
    for (const char* text : {"", "1 2 3\n", "1 2 3 4 5\n", "a b c d\n"})
    {
        folder.write("wxbs/kremlin/corrs.txt", text);
        EXPECT_NE(std::string::npos, messageOf([&] { loadPair(pairs[0]); }).find("corrs.txt")) << text;
    }
    folder.write("wxbs/kremlin/H_1_2", SHIFT);
    EXPECT_TRUE(findPairs({folder.path("")})[0].correspondencesFile.empty());
}

//! As its authors' archive has them: categories of pairs.
TEST(Dataset, folders_of_wxbs)
{
    TestFolder folder;
    for (const char* pair : {"WGALBS/kremlin", "WGBS/petrzin"})
    {
        folder.makeFolder(std::string("WxBS/v1.1/") + pair);
        for (const char* name : {"/01.png", "/02.png"})
            writeImage(folder, std::string("WxBS/v1.1/") + pair + name);
        // As numpy writes them, and beside them what is not read.
        folder.write(std::string("WxBS/v1.1/") + pair + "/corrs.txt", "1.25e+01 2.0e+00 3.5e+00 -4.0e-01\n");
        folder.write(std::string("WxBS/v1.1/") + pair + "/crossval_errors.txt", "0.5\n");
    }
    const std::vector<ImagePair> pairs = findPairs({folder.path("")});
    ASSERT_EQ(2u, pairs.size());
    EXPECT_EQ("WGALBS/kremlin/2", pairs[0].name());
    EXPECT_EQ("WGBS/petrzin/2", pairs[1].name());
    EXPECT_EQ(std::vector<cv::Vec4d>({{12.5, 2, 3.5, -0.4}}), loadPair(pairs[1]).correspondences);
}

TEST(Dataset, folders_of_evd)
{
    TestFolder folder;
    for (const char* part : {"EVD/1", "EVD/2", "EVD/h"})
        folder.makeFolder(part);
    for (const char* name : {"EVD/1/adam.png", "EVD/2/adam.png", "EVD/1/cafe.png"})
        writeImage(folder, name);
    folder.write("EVD/h/adam.txt", SHIFT);
    folder.write("EVD/h/cafe.txt", SHIFT);
    for (const char* root : {"", "EVD"})
    {
        const std::vector<ImagePair> pairs = findPairs({folder.path(root)});
        ASSERT_EQ(2u, pairs.size());
        EXPECT_EQ("EVD/adam/2", pairs[0].name());
        EXPECT_EQ("viewpoint", pairs[0].kind);
        EXPECT_EQ(5, loadPair(pairs[0]).homography(0, 2));
        EXPECT_EQ("EVD/cafe/2", pairs[1].name());
        EXPECT_NE(std::string::npos, messageOf([&] { loadPair(pairs[1]); }).find("2/cafe.png"));
    }
}

TEST(Dataset, static_camera_with_extra_maps)
{
    TestFolder folder;
    folder.makeFolder("room/depth");
    folder.makeFolder("walk/frames");
    writeImage(folder, "walk/frames/1.png");
    writeImage(folder, "walk/frames/2.png");
    folder.makeFolder("walk/depth");
    writeImage(folder, "walk/depth/1.png");
    writeImage(folder, "walk/depth/2.png");
    for (const char* name : {"room/1.png", "room/2.png", "room/depth/1.png", "room/depth/2.png"})
        writeImage(folder, name);
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
    writeImage(folder, "boat/img1.pgm");
    writeImage(folder, "boat/img2.pgm");
    folder.write("boat/H1to2p", SHIFT);
    const std::vector<ImagePair> pairs = findPairs({folder.path("")});
    ASSERT_EQ(1u, pairs.size());
    EXPECT_EQ("zoom", pairs[0].kind);
    EXPECT_EQ(5, loadPair(pairs[0]).homography(0, 2));
}

TEST(Dataset, list_file)
{
    TestFolder folder;
    folder.makeFolder("a");
    writeImage(folder, "a/day.png");
    writeImage(folder, "a/night.png");
    folder.write("H", SHIFT);
    folder.write("pairs.csv", "reference,target,homography,kind\r\na/day.png,a/night.png,H,blur\r\n"
                              "a/night.png,a/day.png,,\nbroken line\n");
    const std::vector<ImagePair> pairs = findPairs({folder.path("pairs.csv")});
    ASSERT_EQ(3u, pairs.size());
    EXPECT_EQ("pairs/a/a_night.png", pairs[0].name());
    EXPECT_EQ("blur", pairs[0].kind);
    EXPECT_EQ(5, loadPair(pairs[0]).homography(0, 2));
    EXPECT_EQ("light", pairs[1].kind);
    EXPECT_EQ(1, loadPair(pairs[1]).homography(0, 0));
    EXPECT_NE(std::string::npos, messageOf([&] { loadPair(pairs[2]); }).find("line 4"));

    folder.write("other.csv", "a/day.png,a/night.png,H,blur\n");
    EXPECT_NE("", messageOf([&] { findPairs({folder.path("other.csv")}); }));
    EXPECT_NE("", messageOf([&] { findPairs({folder.path("missing")}); }));
}

TEST(Dataset, broken_files_are_named)
{
    TestFolder folder;
    folder.makeFolder("s");
    writeImage(folder, "s/1.png");
    folder.write("s/2.png", "no image");
    writeImage(folder, "s/3.png");
    folder.write("s/H_1_2", SHIFT);
    const std::vector<ImagePair> pairs = findPairs({folder.path("")});
    ASSERT_EQ(2u, pairs.size());
    EXPECT_NE(std::string::npos, messageOf([&] { loadPair(pairs[0]); }).find("2.png: not a readable image"));
    EXPECT_NE(std::string::npos, messageOf([&] { loadPair(pairs[1]); }).find("H_1_3: cannot be read"));
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
