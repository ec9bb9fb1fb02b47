// SPDX-License-Identifier: Apache-2.0

#include <sys/resource.h>
#include <sys/stat.h>

#include <csignal>
#include <cstdlib>
#include <filesystem>

#include "iib_geometry/test/wall.hpp"

namespace {
using namespace opencv_test;

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

    //! The exit status; `said` and `error` get standard output, unless it goes elsewhere, and error.
    int run(const std::string& command, const std::string& output = "")
    {
        const std::string line = "'" IIB_PROGRAMS "'/" + command + " >'" +
                                 (output.empty() ? folder.path("said") : output) + "' 2>'" +
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
    EXPECT_FALSE(cv::imread(folder.path("out/matches/left side/0.png.png")).empty());
    EXPECT_EQ(before, textOf(folder.path("images/3.png")));
}

TEST_F(Programs, older_results_stay_until_new_ones_are_whole)
{
    ASSERT_EQ(0, localize("images", "out", "--pictures")) << error;
    const std::string frames = textOf(folder.path("out/frames.csv"));
    EXPECT_EQ(1, localize("images", "out", "--imu " + folder.path("none.csv")));
    EXPECT_EQ("iib_localize: " + folder.path("none.csv") + " cannot be opened, or is empty\n", error);
    folder.write("imu.csv", "0,0,0,0,0,0,0\n");
    EXPECT_EQ(1, localize("images", "out", "--imu " + folder.path("imu.csv")));
    EXPECT_NE(std::string::npos, error.find("must be named by their times")) << error;
    EXPECT_EQ(2, localize("images", "out", "--camera EQUIRECTANGULAR,1,1,1"));
    EXPECT_EQ(2, localize("images", "out", "--imu-from-camera 1e300,0,0,0,0,0,1"));
    EXPECT_EQ(2, localize("images", "out", "more"));
    EXPECT_EQ("iib_localize: more: only options are taken (--help lists them)\n", error);
    EXPECT_EQ(2, localize("images", "out", "--imu-from-camera 0,0,0,1,1,1,1"));
    EXPECT_EQ("iib_localize: 0,0,0,1,1,1,1 is not tx,ty,tz,qx,qy,qz,qw with a quaternion of length 1 and "
              "metres\n",
            error);
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
    for (int i = 0; i < 6; i++)  // 8.5 to 13.5 seconds, which sort otherwise as text
        cv::imwrite(folder.path("timed/" + std::to_string(8 + i) + ".500000.png"),
                i == 1 ? cv::Mat(SIZE, CV_8U, cv::Scalar(7)) : wall.image(poseAt(0.1, -0.1, 0.1)));
    std::string readings;
    const cv::Vec3d felt = poseAt(0.1, -0.1, 0.1).rotation().t() * cv::Vec3d(0, -9.81, 0);
    for (int64_t time = 8000000000; time <= 14000000000; time += 5000000)
        readings += cv::format("%lld,0,0,0,%.9f,%.9f,%.9f\n", (long long)time, felt[0], felt[1], felt[2]);
    folder.write("imu.csv", readings);
    EXPECT_EQ(4, localize("timed", "out"));
    EXPECT_EQ(0, localize("timed", "out", "--imu " + folder.path("imu.csv"))) << error;
    EXPECT_EQ("6 of 6 images have a pose\n", said);
    const std::vector<std::string> lines = split(textOf(folder.path("out/trajectory.txt")), '\n');
    expectPose(split(lines.at(2), ' '), "9.500000", poseAt(0.1, -0.1, 0.1));
    folder.makeFolder("later");
    cv::imwrite(folder.path("later/1500000000000000.png"), wall.image(poseAt(0.1, -0.1, 0.1)));
    EXPECT_EQ(1, localize("later", "out", "--imu " + folder.path("imu.csv"))) << "microseconds";
    EXPECT_NE(std::string::npos, error.find("are not those of the IMU's readings")) << error;
    cv::imwrite(folder.path("timed/08.5.png"), cv::Mat(SIZE, CV_8U, cv::Scalar(7)));
    EXPECT_EQ(1, localize("timed", "out", "--imu " + folder.path("imu.csv")));
    EXPECT_EQ("iib_localize: 08.5.png and 8.500000.png have one time\n", error);
    folder.write("imu.csv", "# a head\n");
    EXPECT_EQ(1, localize("timed", "out", "--imu " + folder.path("imu.csv")));
    EXPECT_EQ("iib_localize: " + folder.path("imu.csv") + " has no readings\n", error);
    EXPECT_EQ(1, localize("timed", "out", "--imu " + folder.path("timed")));
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
    folder.write("paths", "#a.png\n");
    EXPECT_EQ(3, run("iib_localize --stream --map " + folder.path("map") + " <" + folder.path("paths")));
    EXPECT_EQ("# #a.png: a path must not begin with #: write ./ before it\n", said);
    folder.write("paths", third + "\n");
    EXPECT_EQ(1, run("iib_localize --stream --map " + folder.path("map") + " <" + folder.path("paths"),
                         "/dev/full"));
    EXPECT_EQ("iib_localize: standard output cannot be written\n", error);
}

TEST_F(Programs, large_images_are_reduced)
{
    int red = 0;  // pixels of the lines from where points are seen to where the pose has them
    const auto places = [&](const std::string& size) {
        EXPECT_EQ(4, localize("dark", "out", "--pictures --max-size " + size)) << error;
        const std::vector<std::string> lines = split(textOf(folder.path("out/trajectory.txt")), '\n');
        expectPose(split(lines.at(1), ' '), "1 of 2, \"left\"", poseAt(0.1, -0.1, 0.1));
        const cv::Mat picture = cv::imread(folder.path("out/matches/1 of 2, \"left\".png.png"));
        EXPECT_EQ(SIZE, picture.size());
        cv::Mat isRed;
        cv::inRange(picture, cv::Scalar(0, 0, 255), cv::Scalar(0, 0, 255), isRed);
        red = cv::countNonZero(isRed);
        return lines.at(1);
    };
    const std::string whole = places("0");
    EXPECT_EQ(whole, places("320")) << "no larger than that";
    const int before = red;
    EXPECT_NE(whole, places("250"));
    EXPECT_LT(red, 3 * before) << "no longer than there";
    EXPECT_EQ(2, localize("dark", "out", "--max-size 31"));
    EXPECT_EQ("iib_localize: --max-size is 31: at least 32 pixels are needed, or 0\n", error);
}

TEST_F(Programs, a_full_disk_keeps_older_results)
{
    ASSERT_EQ(0, localize("images", "out", "--pictures")) << error;
    const std::string table = textOf(folder.path("out/frames.csv"));
    rlimit before;
    ::getrlimit(RLIMIT_FSIZE, &before);
    ::signal(SIGXFSZ, SIG_IGN);
    const std::pair<rlim_t, const char*> cases[] = {{600, ""}, {1200, ""}, {20000, "--pictures"}};
    for (const auto& [size, options] : cases)  // no file may be larger
    {
        const rlimit limit = {size, before.rlim_max};
        ::setrlimit(RLIMIT_FSIZE, &limit);
        const int status = localize("images", "out", options);
        ::setrlimit(RLIMIT_FSIZE, &before);
        EXPECT_EQ(1, status) << size;
        EXPECT_NE(std::string::npos, error.find(" cannot be written\n")) << error;
        EXPECT_EQ(table, textOf(folder.path("out/frames.csv")));
        EXPECT_FALSE(cv::utils::fs::exists(folder.path("out.iib_partial")));
    }
}

TEST_F(Programs, folders_that_cannot_be_made_or_read)
{
    folder.write("file", "");
    std::filesystem::create_symlink("loop", folder.path("loop"));
    for (const char* bad : {"file/out", "loop/out"})
    {
        EXPECT_EQ(1, localize("dark", bad)) << bad;
        EXPECT_EQ(0u, error.find("iib_localize: " + folder.path(bad) + " cannot be written: ")) << error;
    }
    EXPECT_EQ(1, localize("loop", "out"));
    EXPECT_EQ(0u, error.find("iib_localize: " + folder.path("loop") + " or a folder in it cannot be read: "))
            << error;
}

TEST_F(Programs, images_that_cannot_be_read)
{
    folder.makeFolder("bad");
    cv::imwrite(folder.path("bad/whole.jpg"), wall.image(poseAt(0.1, -0.1, 0.1)));
    const std::string jpeg = textOf(folder.path("bad/whole.jpg"));
    folder.write("bad/cut.jpg", jpeg.substr(0, jpeg.size() * 2 / 3));
    folder.write("bad/huge.pgm", "P5\n100000 100000\n255\n");
    ASSERT_EQ(0, ::mkfifo(folder.path("bad/pipe.png").c_str(), 0600));
    std::filesystem::create_symlink("loop.png", folder.path("bad/loop.png"));
    EXPECT_EQ(4, localize("bad", "out")) << error;
    const std::vector<std::string> rows = split(textOf(folder.path("out/frames.csv")), '\n');
    ASSERT_EQ(6u, rows.size());
    for (size_t i = 1; i < 5; i++)
        EXPECT_NE(std::string::npos, rows[i].find(",0,the image cannot be read,0,0,")) << rows[i];
    EXPECT_EQ(0u, rows[5].find("whole.jpg,1,,")) << rows[5];
}

TEST_F(Programs, results_are_no_images)
{
    EXPECT_EQ(4, localize("dark", "dark/out", "--pictures")) << error;
    folder.makeFolder("dark/out.iib_partial/matches");
    cv::imwrite(folder.path("dark/out.iib_partial/matches/killed.png"), cv::Mat(SIZE, CV_8U, cv::Scalar(7)));
    EXPECT_EQ(4, localize("dark", "dark/out", "--pictures")) << error;
    EXPECT_EQ("1 of 2 images have a pose\n", said);
}

TEST_F(Programs, an_image_turned_by_exif_is_taken_as_it_is_stored)
{
    folder.makeFolder("turned");
    cv::imwrite(folder.path("turned/a.jpg"), wall.image(poseAt(0.1, -0.1, 0.1)));
    std::string jpeg = textOf(folder.path("turned/a.jpg"));
    const std::string exif("\xff\xe1\0\x22"
                           "Exif\0\0"
                           "MM\0*\0\0\0\x08\0\1\x01\x12\0\3\0\0\0\1\0\6\0\0\0\0\0\0",
            36);
    folder.write("turned/a.jpg", jpeg.insert(2, exif));
    EXPECT_EQ(cv::Size(SIZE.height, SIZE.width), cv::imread(folder.path("turned/a.jpg")).size());
    EXPECT_EQ(0, localize("turned", "out")) << textOf(folder.path("out/frames.csv"));
}

}  // namespace
