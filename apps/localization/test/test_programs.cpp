// SPDX-License-Identifier: Apache-2.0

#include <cstdlib>

#include "iib_geometry/test/wall.hpp"

namespace {
using namespace iib_localization;

//! Lines of a text, and what stands between their separators.
std::vector<std::string> split(const std::string& text, char separator)
{
    std::vector<std::string> parts;
    for (size_t from = 0; from < text.size();)
    {
        const size_t to = std::min(text.find(separator, from), text.size());
        parts.push_back(text.substr(from, to - from));
        from = to + 1;
    }
    return parts;
}

//! iib_localize as a program, in a map of the wall.
class Programs : public WallTest
{
protected:
    Programs()
    {
        folder.makeFolder("dark");
        cv::imwrite(folder.path("dark/1 of 2, \"left\".png"), wall.image(poseAt(0.1, -0.1, 0.1)) * 0.3);
        folder.write("dark/none.png", "");
    }

    //! The exit status; `said` and `error` get standard output and error.
    int run(const std::string& command)
    {
        const std::string line = "'" IIB_PROGRAMS "'/" + command + " >'" + folder.path("said") + "' 2>'" +
                                 folder.path("error") + "'";
        const int status = std::system(line.c_str());
        said = textOf(folder.path("said"));
        error = textOf(folder.path("error"));
        return WEXITSTATUS(status);
    }

    int localize(const std::string& images, const std::string& out, const std::string& more = "")
    {
        return run("iib_localize --map " + folder.path("map") + " --images " + folder.path(images) +
                   " --out " + folder.path(out) + " " + more);
    }

    void expectPose(const std::vector<std::string>& words, const std::string& name, const cv::Affine3d& truth)
    {
        ASSERT_GE(words.size(), 8u);
        std::string found;
        for (size_t i = 0; i + 7 < words.size(); i++)
            found += (i ? " " : "") + words[i];
        EXPECT_EQ(name, found);
        double v[7];
        for (size_t i = 0; i < 7; i++)
            v[i] = std::stod(words[words.size() - 7 + i]);
        EXPECT_LT(cv::norm(cv::Vec3d(v) - truth.translation()), 0.02);
        const cv::Matx33d rotation = cv::Quatd(v[6], v[3], v[4], v[5]).toRotMat3x3();
        EXPECT_LT(cv::norm(cv::Affine3d(rotation * truth.rotation().t()).rvec()), 0.01);
    }

    std::string said, error;
};

TEST_F(Programs, names_with_blanks_commas_and_quotes)
{
    EXPECT_EQ(4, localize("dark", "out", "--pictures")) << "one of two" << error;
    EXPECT_EQ("1 of 2 images have a pose\n", said);
    const std::vector<std::string> lines = split(textOf(folder.path("out/trajectory.txt")), '\n');
    ASSERT_EQ(2u, lines.size());
    expectPose(split(lines[1], ' '), "1 of 2, \"left\"", poseAt(0.1, -0.1, 0.1));
    const std::vector<std::string> rows = split(textOf(folder.path("out/frames.csv")), '\n');
    ASSERT_EQ(3u, rows.size());
    EXPECT_EQ(26u, split(rows[0], ',').size());
    EXPECT_EQ(0u, rows[0].find("name,found,reason,matches,inliers,x_x,x_y,x_z,x_rx,"));
    EXPECT_EQ(0u, rows[1].find("\"1 of 2, \"\"left\"\".png\",1,,")) << rows[1];
    const std::vector<std::string> fields = split(rows[1], ',');
    EXPECT_GT(std::stod(fields.at(6)), 0) << "variance of x, behind a name with a comma";
    EXPECT_EQ(0u, rows[2].find("none.png,0,the image cannot be read,0,0,,")) << rows[2];
    EXPECT_FALSE(cv::imread(folder.path("out/matches/1 of 2, \"left\".png.png")).empty());
}

TEST_F(Programs, a_model_in_place_of_a_map)
{
    write(model(1, 2));
    const std::string sparse = "--model '" + folder.path("sparse 0") + "' ",
                      made = sparse + "--photographs " + folder.path("images") + " ",
                      rest = "--images " + folder.path("dark") + " --out " + folder.path("out");
    EXPECT_EQ(4, run("iib_localize " + made + rest)) << error;
    EXPECT_EQ("6.png cannot be read: left out of the map\n", error);
    const std::vector<std::string> lines = split(textOf(folder.path("out/trajectory.txt")), '\n');
    expectPose(split(lines.at(1), ' '), "1 of 2, \"left\"", poseAt(0.1, -0.1, 0.1));

    for (const std::string& wrong : {sparse, made + "--map " + folder.path("map") + " ", std::string()})
    {
        EXPECT_EQ(2, run("iib_localize " + wrong + rest));
        EXPECT_EQ("iib_localize: either --map or --model and --photographs are needed (--help tells more)\n",
                error);
    }
    folder.write("sparse 0/images.bin", "");
    EXPECT_EQ(1, run("iib_localize " + made + rest));
    EXPECT_EQ("iib_localize: " + folder.path("sparse 0") + " is no COLMAP model",
            error.substr(0, error.find(", or")));
    EXPECT_EQ(error.size() - 1, error.find('\n')) << "one line";
}

TEST_F(Programs, pictures_do_not_overwrite_photographs)
{
    const std::string before = textOf(folder.path("images/3.png"));
    EXPECT_EQ(1, localize("images", "images", "--pictures"));
    EXPECT_NE(std::string::npos, error.find("not written by this program: choose another folder\n")) << error;
    EXPECT_EQ(before, textOf(folder.path("images/3.png")));
    EXPECT_EQ(0, localize("images", "out", "--pictures")) << error;
    EXPECT_FALSE(cv::imread(folder.path("out/matches/left side-0.png.png")).empty());
    EXPECT_EQ(before, textOf(folder.path("images/3.png")));
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
    EXPECT_EQ(2, localize("images", "out", "--camera EQUIRECTANGULAR,1,1,1"));
    EXPECT_EQ(2, localize("images", "out", "--imu-from-camera 0,0,0,1,1,1,1"));
    EXPECT_EQ(
            "iib_localize: 0,0,0,1,1,1,1 is not tx,ty,tz,qx,qy,qz,qw with a quaternion of length 1\n", error);
    EXPECT_EQ(1, run("iib_localize --map " + folder.path("dark") + " --images " + folder.path("images") +
                         " --out " + folder.path("out")));
    EXPECT_EQ("iib_localize: " + folder.path("dark") + " is no map: it has no map.iib\n", error);
    EXPECT_EQ(frames, textOf(folder.path("out/frames.csv")));

    folder.makeFolder("none");
    cv::imwrite(folder.path("none/k0.png"), cv::Mat(SIZE, CV_8U, cv::Scalar(7)));
    EXPECT_EQ(3, localize("none", "out")) << "no pose";
    EXPECT_EQ("# name tx ty tz qx qy qz qw\n", textOf(folder.path("out/trajectory.txt")));
    EXPECT_NE(std::string::npos, textOf(folder.path("out/frames.csv")).find("k0.png,0,too few matches,"));
    EXPECT_FALSE(cv::utils::fs::exists(folder.path("out/matches")));
    EXPECT_EQ(3, localize("none", "out", "--camera PINHOLE,64,48,50,50,32,24"));
    EXPECT_NE(std::string::npos,
            textOf(folder.path("out/frames.csv")).find("no camera of 320 x 240 pixels: give --camera"));
}

TEST_F(Programs, with_an_imu)
{
    // the camera stands still, and its second image tells nothing
    folder.makeFolder("timed");
    for (int i = 0; i < 6; i++)
        cv::imwrite(folder.path("timed/0" + std::to_string(i) + ".500000.png"),
                i == 1 ? cv::Mat(SIZE, CV_8U, cv::Scalar(7)) : wall.image(poseAt(0.1, -0.1, 0.1)));
    std::string readings;
    const cv::Vec3d felt = poseAt(0.1, -0.1, 0.1).rotation().t() * cv::Vec3d(0, -9.81, 0);
    for (int64_t time = 0; time <= 6000000000; time += 5000000)
        readings += cv::format("%lld,0,0,0,%.9f,%.9f,%.9f\n", (long long)time, felt[0], felt[1], felt[2]);
    folder.write("imu.csv", readings);
    EXPECT_EQ(4, localize("timed", "out"));
    EXPECT_EQ(0, localize("timed", "out", "--imu " + folder.path("imu.csv"))) << error;
    EXPECT_EQ("6 of 6 images have a pose\n", said);
    const std::vector<std::string> lines = split(textOf(folder.path("out/trajectory.txt")), '\n');
    expectPose(split(lines.at(2), ' '), "01.500000", poseAt(0.1, -0.1, 0.1));
}

TEST_F(Programs, stream_a_path_and_a_pose_a_line)
{
    const std::string first = folder.path("images/3.png"), second = folder.path("dark/none.png"),
                      third = folder.path("dark/1 of 2, \"left\".png");
    folder.write("paths", first + "\n" + second + "\n" + third + "\n" + third);
    EXPECT_EQ(4, run("iib_localize --stream --map " + folder.path("map") +
                         " --camera PINHOLE,320,240,260,260,160,120 <'" + folder.path("paths") + "'"))
            << error;
    const std::vector<std::string> lines = split(said, '\n');
    ASSERT_EQ(4u, lines.size());
    expectPose(split(lines[0], ' '), first, poseAt(0.1, 0.05, 0.09));
    EXPECT_EQ("# " + second + ": the image cannot be read", lines[1]);
    for (size_t i : {2, 3})
        expectPose(split(lines[i], ' '), third, poseAt(0.1, -0.1, 0.1));
    EXPECT_EQ(2, run("iib_localize --stream --map " + folder.path("map") + " --out " + folder.path("out")));
    EXPECT_EQ("iib_localize: --stream goes without --out\n", error);
    EXPECT_EQ(2, run("iib_localize --map " + folder.path("map")));
}

}  // namespace
