// SPDX-License-Identifier: Apache-2.0

#include "../src/map.hpp"
#include "common/test/test_folder.hpp"

namespace {
using namespace iib_localization;

Map smallMap()
{
    Map map;
    map.features = "iib";
    map.description = "iib preset -1";
    map.model.cameras[1] = {"PINHOLE", {640, 480}, {500, 500, 320, 240}};
    map.model.points = {{0, 0, 5}, {1, 0, 5}, {0, 1, 6}};
    cv::Mat codes(3, 170, CV_8U);
    cv::RNG(1).fill(codes, cv::RNG::UNIFORM, 0, 256);
    map.model.keyframes = {{"a.png", 1, {}, {{1, 2}, {3, 4}, {5.5, 6}}, {0, 1, 2}},
            {"none.png", 1, {}, {}, {}}, {"b.png", 1, {}, {{7, 8}}, {1}}};
    map.codes = {{codes.rowRange(0, 2), codes.rowRange(2, 3)},
            {cv::Mat(0, 170, CV_8U), cv::Mat(0, 170, CV_8U)}, {codes.rowRange(1, 2), cv::Mat(0, 170, CV_8U)}};
    return map;
}

Map mapWithLines()
{
    Map map = smallMap();
    cv::Mat codes(3, 32, CV_8U);
    cv::RNG(2).fill(codes, cv::RNG::UNIFORM, 0, 256);
    map.lines.lines = {{{0.1, 0.2, 5}, {1, 2, 6}, {{0, {{1, 2}, {30.25, 40}}}, {2, {{3, 4}, {5, 60}}}}},
            {{0, 0, 1}, {0, 0, 2}, {{0, {{7, 8}, {9, 10}}}}}};
    map.lines.codes = {codes.rowRange(0, 2), cv::Mat(0, 32, CV_8U), codes.rowRange(2, 3)};
    return map;
}

std::vector<double> numbers(const MapLine& line)
{
    std::vector<double> result(line.begin.data(), line.begin.data() + 3);
    result.insert(result.end(), line.end.data(), line.end.data() + 3);
    for (const LineSight& s : line.sights)
        result.insert(result.end(), {double(s.keyframe), s.segment.begin.x(), s.segment.begin.y(),
                                            s.segment.end.x(), s.segment.end.y()});
    return result;
}

std::string errorOf(const std::string& folder)
{
    return messageOf([&] { readMap(folder); });
}

TEST(Map, round_trip_also_over_an_old_one)
{
    const TestFolder folder;
    Map map = smallMap();
    map.model.points[0].x() = 9;
    writeMap(placeOfMap(folder.path("map")), map);
    writeMap(placeOfMap(folder.path("map/")), smallMap());
    map = smallMap();
    const Map back = readMap(folder.path("map"));
    EXPECT_EQ(map.features, back.features);
    EXPECT_EQ(map.description, back.description);
    EXPECT_EQ(map.model.points, back.model.points);
    ASSERT_EQ(3u, back.codes.size());
    for (size_t k = 0; k < 3; k++)
        for (size_t d = 0; d < 2; d++)
        {
            ASSERT_EQ(map.codes[k][d].rows, back.codes[k][d].rows);
            EXPECT_TRUE(
                    map.codes[k][d].empty() || cv::countNonZero(map.codes[k][d] != back.codes[k][d]) == 0);
        }
    EXPECT_EQ(4u * 170, back.codeBytes());
    EXPECT_EQ(3u * 3 * sizeof(double) + 4u * (2 * sizeof(double) + sizeof(int)), back.pointBytes());
    std::vector<cv::String> left;
    cv::utils::fs::glob(folder.path("."), "", left, false, true);
    EXPECT_EQ(1u, left.size()) << "nothing beside the map";
}

TEST(Map, lines_round_trip)
{
    const TestFolder folder;
    const Map map = mapWithLines();
    writeMap(placeOfMap(folder.path("map")), map);
    const Map back = readMap(folder.path("map"));
    ASSERT_EQ(2u, back.lines.lines.size());
    for (size_t i : {0, 1})
        EXPECT_EQ(numbers(map.lines.lines[i]), numbers(back.lines.lines[i]));
    ASSERT_EQ(3u, back.lines.codes.size());
    for (size_t k = 0; k < 3; k++)
    {
        ASSERT_EQ(map.lines.codes[k].size(), back.lines.codes[k].size());
        EXPECT_TRUE(k == 1 || cv::countNonZero(map.lines.codes[k] != back.lines.codes[k]) == 0);
    }
    const std::vector<std::vector<int>> seen = {{0, 1}, {}, {0}};
    EXPECT_EQ(seen, linesOfKeyframes(back.lines.lines, 3));
    EXPECT_EQ(map.lines.bytes(), back.lines.bytes());

    writeMap(placeOfMap(folder.path("map")), smallMap());
    EXPECT_TRUE(readMap(folder.path("map")).lines.lines.empty()) << "a map without lines is one";
}

TEST(Map, refuses_damaged_lines)
{
    const TestFolder folder;
    const std::string map = folder.path("map");
    for (const char* file : {"lines3D.txt", "codes_lines.iib"})
    {
        writeMap(placeOfMap(map), mapWithLines());
        std::ofstream(map + "/" + file, std::ios::app) << " ";
        EXPECT_EQ(map + "/" + file + " is damaged: build the map again", errorOf(map));
        ASSERT_EQ(0, std::remove((map + "/" + file).c_str()));
        EXPECT_EQ(map + "/" + file + " is missing: the map is not whole", errorOf(map));
    }
    Map wrong = mapWithLines();
    wrong.lines.codes[0] = wrong.lines.codes[0].rowRange(0, 1);
    writeMap(placeOfMap(map), wrong);
    EXPECT_EQ(map + ": a.png has not a code for each line", errorOf(map));

    const std::string path = folder.path("lines");
    const auto error = [&](const std::string& text) {
        folder.write("lines", text);
        return messageOf([&] { readLines(path, 3); });
    };
    EXPECT_EQ("", error("#\n1 0 0 1 0 0 2 3 1 2 3 4\n2 0 0 1 0 0 2 1 1 2 3 4\n"));
    EXPECT_EQ(path + ":1: '2' is no whole number from 1 to 1", error("2 0 0 1 0 0 2 3 1 2 3 4\n"));
    EXPECT_EQ(path + ":1: '4' is no whole number from 1 to 3", error("1 0 0 1 0 0 2 4 1 2 3 4\n"));
    EXPECT_EQ(path + ":1: 'inf' is no number", error("1 0 0 inf 0 0 2 3 1 2 3 4\n"));
    for (const char* size : {"1 0 0 1 0 0 2\n", "1 0 0 1 0 0 2 3 1 2 3\n"})
        EXPECT_EQ(path + ":1: not LINE3D_ID X1 Y1 Z1 X2 Y2 Z2 and IMAGE_ID U1 V1 U2 V2 of each sight",
                error(size));
}

TEST(Map, refuses_what_is_no_map_and_what_is_damaged)
{
    const TestFolder folder;
    const std::string map = folder.path("map");
    EXPECT_EQ(map + " is no map: it has no map.txt", errorOf(map));
    folder.makeFolder("map");
    folder.write("map/mine.txt", "precious");
    EXPECT_EQ(map + " holds mine.txt, which is no result of this program: choose another folder",
            messageOf([&] { placeOfMap(map); }));
    folder.makeFolder("text");
    folder.write("text/map.txt", "something else\n");
    EXPECT_EQ(folder.path("text") + "/map.txt:1: not the header of a map", errorOf(folder.path("text")));

    ASSERT_EQ(0, std::remove((map + "/mine.txt").c_str()));
    writeMap(placeOfMap(map), smallMap());
    for (const char* file : {"cameras.txt", "images.txt", "points3D.txt", "codes_0.iib", "codes_1.iib"})
    {
        writeMap(placeOfMap(map), smallMap());
        std::ofstream(map + "/" + file, std::ios::app) << " ";
        EXPECT_EQ(map + "/" + file + " is damaged: build the map again", errorOf(map));
        ASSERT_EQ(0, std::remove((map + "/" + file).c_str()));
        EXPECT_EQ(map + "/" + file + " is missing: the map is not whole", errorOf(map));
    }
}

TEST(Map, a_failed_write_leaves_the_old_one)
{
    const TestFolder folder;
    writeMap(placeOfMap(folder.path("map")), smallMap());
    Map broken = smallMap();
    broken.codes[2][0] = cv::Mat(1, 64, CV_8U, cv::Scalar(0));  // of another width
    EXPECT_NE("", messageOf([&] { writeMap(placeOfMap(folder.path("map")), broken); }));
    EXPECT_EQ("", errorOf(folder.path("map")));
    std::vector<cv::String> left;
    cv::utils::fs::glob(folder.path("."), "", left, false, true);
    EXPECT_EQ(1u, left.size());
}

}  // namespace
