// SPDX-License-Identifier: Apache-2.0

#include <map>
#include <set>

#include "../experiments.hpp"
#include "../results.hpp"
#include "iib_geometry/test/test_folder.hpp"
#include "opencv2/imgcodecs.hpp"
#include "opencv2/imgproc.hpp"

namespace {
using namespace iib_tools;

const int SHIFT = 24;  // pixels between the images

//! Rows of neighbours.csv by method: visible, repeated, nearest.
std::map<std::string, std::vector<int>> neighboursIn(const std::string& out)
{
    std::map<std::string, std::vector<int>> found;
    for (const Fields& row : readRows(
                 out + "/neighbours.csv", {"set", "sequence", "target", "detector", "descriptor", "points",
                                                  "baseline", "contrast", "visible", "repeated", "nearest"}))
        found[row[3] + " " + row[4] + " " + row[5]] = {
                std::atoi(row[8].c_str()), std::atoi(row[9].c_str()), std::atoi(row[10].c_str())};
    return found;
}

//! A wall 4 m away, seen from places half a metre apart.
TEST(Controls, neighbours_by_known_depth)
{
    const TestFolder folder;
    cv::Mat wall(12, 20, CV_8U);
    cv::RNG(5).fill(wall, cv::RNG::UNIFORM, 30, 220);
    cv::resize(wall, wall, cv::Size(320 + SHIFT, 192), 0, 0, cv::INTER_CUBIC);
    folder.makeFolder("wall_2/map/images");
    folder.makeFolder("wall_2/map/depth");
    folder.write("wall_2/map/cameras.txt",
            cv::format("1 PINHOLE 320 192 %d %d 160.5 96.5\n", SHIFT * 8, SHIFT * 8));
    folder.write("wall_2/map/poses.txt", "a 0 0 0 0 0 0 1\nb 0.5 0 0 0 0 0 1\n");
    for (int i : {0, 1})
    {
        const std::string name = i ? "b.png" : "a.png";
        cv::imwrite(folder.path("wall_2/map/images/" + name), wall.colRange(i * SHIFT, i * SHIFT + 320));
        cv::imwrite(folder.path("wall_2/map/depth/" + name), cv::Mat(192, 320, CV_16U, cv::Scalar(1000)));
    }
    Options options;
    options.roots = {folder.path("")};
    options.experiments = {"controls"};
    options.points = 200;
    options.out = folder.path("out");
    EXPECT_EQ(0, evaluate(options));
    const auto found = neighboursIn(options.out);
    EXPECT_EQ(12u + 3 * 3, found.size());  // twelve methods, three of them for other numbers of points too
    for (const char* method : {"Hessian IIB UNIVERSAL 200", "Hessian SIFT 200",
                 "SIFT normalized RootSIFT 200", "SIFT CLAHE SIFT 200"})
    {
        ASSERT_EQ(1u, found.count(method)) << method;
        const std::vector<int>& counts = found.at(method);
        EXPECT_GT(counts[0], 20) << method;
        EXPECT_GT(counts[1], .7 * counts[0]) << method;
        EXPECT_GT(counts[2], .7 * counts[1]) << method;
    }
    std::set<std::string> ratios;
    size_t rows = 0;
    for (const Fields& row :
            readRows(options.out + "/controls.csv", {"set", "sequence", "target", "detector", "descriptor",
                                                            "noise", "ratio", "error", "matches"}))
    {
        ratios.insert(row[6]);
        rows++;
    }
    EXPECT_EQ(5u, ratios.size());
    EXPECT_EQ(5 * (12u + 2 * 7), rows);  // seven methods with each of two noises

    // With a wrong depth no neighbour is right. A more distant wall in one image hides every point.
    cv::imwrite(folder.path("wall_2/map/depth/a.png"), cv::Mat(192, 320, CV_16U, cv::Scalar(300)));
    cv::imwrite(folder.path("wall_2/map/depth/b.png"), cv::Mat(192, 320, CV_16U, cv::Scalar(300)));
    options.out = folder.path("wrong");
    EXPECT_EQ(0, evaluate(options));
    for (const auto& counts : neighboursIn(options.out))
        EXPECT_LE(counts.second[2], .05 * counts.second[0] + 1) << counts.first;
    cv::imwrite(folder.path("wall_2/map/depth/b.png"), cv::Mat(192, 320, CV_16U, cv::Scalar(1000)));
    options.out = folder.path("hidden");
    EXPECT_EQ(0, evaluate(options));
    for (const auto& counts : neighboursIn(options.out))
        EXPECT_EQ(0, counts.second[0]) << counts.first;
}

}  // namespace
