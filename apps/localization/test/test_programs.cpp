// SPDX-License-Identifier: Apache-2.0

#include "wall.hpp"

#include <cstdlib>

#include "../src/images.hpp"

namespace {
using namespace iib_localization;

std::string textOf(const std::string& path)
{
    std::ifstream stream(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

//! iib_map and iib_localize as programs, in and with a map of the wall.
class Programs : public Localization
{
protected:
    Programs()
    {
        sources.depth = folder.path("depth");
        writeMap(placeOfMap(folder.path("map")), buildMap(sources));
    }

    //! The exit status; `error` gets the standard error.
    int run(const std::string& command)
    {
        const std::string line = "'" IIB_PROGRAMS "'/" + command + " >'" + folder.path("said") + "' 2>'" +
                                 folder.path("error") + "'";
        const int status = std::system(line.c_str());
        error = textOf(folder.path("error"));
        return WEXITSTATUS(status);
    }

    int localize(const std::string& images, const std::string& out, const std::string& more = "")
    {
        return run("iib_localize --map " + folder.path("map") + " --cameras " + folder.path("cameras.txt") +
                   " --images " + folder.path(images) + " --out " + folder.path(out) + " " + more);
    }

    std::string error;
};

TEST_F(Programs, pictures_do_not_overwrite_photographs)
{
    const std::string before = textOf(folder.path("images/k0.png"));
    EXPECT_EQ(1, localize("images", "images", "--pictures"));
    EXPECT_NE(std::string::npos, error.find("no result of this program: choose another folder\n")) << error;
    EXPECT_EQ(6u, listImages(folder.path("images")).size());
    EXPECT_EQ(before, textOf(folder.path("images/k0.png")));

    EXPECT_EQ(0, localize("images", "out", "--pictures")) << error;
    EXPECT_EQ(6u, readTrajectory(folder.path("out/trajectory.txt")).size());
    EXPECT_EQ(6u, listImages(folder.path("out")).size());
    EXPECT_FALSE(cv::imread(folder.path("out/k5.matches.png")).empty());
}

TEST_F(Programs, older_results_stay_until_new_ones_are_whole)
{
    ASSERT_EQ(0, localize("images", "out", "--pictures")) << error;
    const std::string frames = textOf(folder.path("out/frames.csv"));
    EXPECT_EQ(1, localize("images", "out", "--imu " + folder.path("none.csv")));
    EXPECT_EQ("iib_localize: " + folder.path("none.csv") + " cannot be opened\n", error);
    folder.write("imu.csv", "0,0,0,0,0,0,0\n");
    EXPECT_EQ(1, localize("images", "out", "--imu " + folder.path("imu.csv")));
    EXPECT_NE(std::string::npos, error.find("must be named by their times")) << error;
    EXPECT_EQ(frames, textOf(folder.path("out/frames.csv")));

    folder.makeFolder("none");
    cv::imwrite(folder.path("none/k0.png"), cv::Mat(SIZE, CV_8U, cv::Scalar(7)));
    EXPECT_EQ(3, localize("none", "out")) << "no pose";
    EXPECT_TRUE(readTrajectory(folder.path("out/trajectory.txt")).empty());
    EXPECT_NE(std::string::npos, textOf(folder.path("out/frames.csv")).find("k0,0,too few matches,"));
    EXPECT_FALSE(cv::utils::fs::exists(folder.path("out/k0.matches.png")));
}

TEST_F(Programs, a_model_that_the_poses_come_from_is_not_replaced_by_the_map)
{
    folder.makeFolder("model");
    writeModel(folder.path("model"), readModel(folder.path("map")));
    const std::string before = textOf(folder.path("model/images.txt"));
    EXPECT_EQ(1, run("iib_map build --images " + folder.path("images") + " --cameras " +
                         folder.path("cameras.txt") + " --poses " + folder.path("model") + " --out " +
                         folder.path("model")));
    EXPECT_NE(std::string::npos, error.find("choose another folder\n")) << error;
    EXPECT_EQ(before, textOf(folder.path("model/images.txt")));
}

}  // namespace
