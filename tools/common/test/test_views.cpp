// SPDX-License-Identifier: Apache-2.0

#include "../dataset.hpp"
#include "../views.hpp"
#include "opencv2/imgcodecs.hpp"
#include "iib_geometry/test/test_folder.hpp"

namespace {
using namespace iib_tools;

const char* const CAMERA = "# comment\n1 PINHOLE 30 20 25 26 15 10\n";

class ViewsTest : public ::testing::Test
{
protected:
    void addFolder(const std::string& name, const std::string& poses, const std::vector<std::string>& images)
    {
        folder.makeFolder(name + "/images");
        folder.write(name + "/cameras.txt", CAMERA);
        folder.write(name + "/poses.txt", "# comment\n" + poses);
        for (const std::string& image : images)
            ASSERT_TRUE(cv::imwrite(
                    folder.path(name + "/images/" + image + ".png"), cv::Mat(20, 30, CV_8U, cv::Scalar(9))));
    }

    TestFolder folder;
};

TEST_F(ViewsTest, neighbours_of_a_folder)
{
    // The camera moves along x; the second one is rotated by 90 degrees about y.
    addFolder("set/walk",
            "0 0 0 0 0 0 0 1\n1 2 0 0 0 0.70710678 0 0.70710678\n2 3 0 0 0 0 0 1\n3 4 0 0 0 0 0 1\n4 5 0 0 0 "
            "0 0 1\n"
            "5 6 0 0 0 0 0 1\n",
            {"0", "1", "2", "3", "5"});
    EXPECT_TRUE(holdsViews(folder.path("set/walk")));
    EXPECT_FALSE(holdsViews(folder.path("set")));
    const std::vector<ViewPair> pairs = findViewPairs({folder.path("")});
    ASSERT_EQ(3u + 3 + 2 + 1, pairs.size());  // without image 4
    EXPECT_EQ("set", pairs[0].set);
    EXPECT_EQ("walk", pairs[0].sequence);
    EXPECT_EQ("0-1", pairs[0].target);
    EXPECT_EQ(26, pairs[0].targetCamera(1, 1));
    EXPECT_EQ(9.5, pairs[0].targetCamera(1, 2));  // COLMAP's 10
    // The world's x axis is the second camera's z axis; the first stands two metres behind it.
    EXPECT_NEAR(1, pairs[0].rotation(2, 0), 1e-6);
    EXPECT_NEAR(-2, pairs[0].translation[2], 1e-6);
    EXPECT_NEAR(0, pairs[0].translation[0], 1e-6);
    // Views are not sequences of a static camera.
    EXPECT_TRUE(findPairs({folder.path("set")}).empty());
}

TEST_F(ViewsTest, visits_are_paired_with_the_map)
{
    addFolder("s/map", "a 0 0 0 0 0 0 1\nb 1 0 0 0 0 0 1\nc 9 0 0 0 0 0 1\n", {"a", "b", "c"});
    addFolder("s/night", "x 0.9 0 0 0 0 0 1\ny 8 0 0 0 0 0 1\n", {"x", "y"});
    const std::vector<ViewPair> pairs = findViewPairs({folder.path("")});
    std::vector<std::string> found;
    for (const ViewPair& pair : pairs)
        found.push_back(pair.sequence + " " + pair.target);
    // b is too near to x; pairs within the map would be under the same illumination.
    EXPECT_EQ(std::vector<std::string>({"night a-x", "night c-y"}), found);

    addFolder("alone/map", "a 0 0 0 0 0 0 1\nb 1 0 0 0 0 0 1\n", {"a", "b"});
    EXPECT_EQ(1u, findViewPairs({folder.path("alone")}).size());
}

TEST_F(ViewsTest, broken_files_are_reported)
{
    addFolder("s/walk", "a 0 0 0 0 0 0 1\n", {"a"});
    const auto message = [&] { return messageOf([&] { findViewPairs({folder.path("")}); }); };
    EXPECT_EQ("", message());
    folder.write("s/walk/poses.txt", "a 0 0 0 0 0 0 1\na 0 0 0 0 0 0 3\n");
    EXPECT_NE(std::string::npos, message().find("poses.txt, line 2"));
    folder.write("s/walk/poses.txt", "a 0 0 0 0 0 0\n");
    EXPECT_NE(std::string::npos, message().find("poses.txt, line 1"));
    folder.write("s/walk/poses.txt", "");
    folder.write("s/walk/cameras.txt", "1 OPENCV 30 20 25 26 15 10 0 0 0 0\n");
    EXPECT_NE(std::string::npos, message().find("cameras.txt, line 1"));
    folder.write("s/walk/cameras.txt", "");
    EXPECT_NE(std::string::npos, message().find("needs exactly one PINHOLE camera"));
}

}  // namespace
