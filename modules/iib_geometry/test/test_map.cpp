// SPDX-License-Identifier: Apache-2.0

#include "map_writer.hpp"
#include "wall.hpp"

namespace {
using namespace iib_localization;

Map smallMap()
{
    Map map;
    map.keypoints = 500;
    map.cameras = {{"PINHOLE", {640, 480}, {500, 500, 320, 240.5}}, {"FOV", {64, 48}, {50, 50, 32, 24, .5}}};
    map.points = (cv::Mat_<double>(3, 3) << 0, 0, 5, 1, 0, 5, .1, 1, 6);
    map.sees = (cv::Mat_<int>(3, 1) << 0, 2, 1);
    map.codes.create(3, 128, CV_8U);
    cv::RNG(1).fill(map.codes, cv::RNG::UNIFORM, 0, 256);
    const cv::Vec3d centre(1, 2, 3), ahead(0, 0, 1);
    map.views = {{{0, 2}, centre, ahead, 4}, {{2, 2}, centre, ahead, 1}, {{2, 3}, -centre, ahead, 5}};
    return map;
}

bool equal(const cv::Mat& a, const cv::Mat& b)
{
    return a.type() == b.type() && a.size() == b.size() && cv::norm(a, b, cv::NORM_INF) == 0;
}

struct SmallMap : public testing::Test
{
    SmallMap() : map(folder.path("map")), whole(smallMap()), files(filesOf(whole))
    {
        folder.makeFolder("map");
    }

    //! What is said of a map, behind its name.
    std::string error()
    {
        const std::string said = messageOf([&] { readMap(map); }),
                          begin = map + " is no map, or a damaged one: ";
        EXPECT_EQ(0u, said.find(begin)) << said;
        return said.substr(std::min(begin.size(), said.size()));
    }

    const TestFolder folder;
    const std::string map;
    const Map whole;
    const Files files;
};

TEST_F(SmallMap, read_as_written)
{
    writeMap(map, whole);
    const Map back = readMap(map);
    ASSERT_EQ(2u, back.cameras.size());
    for (size_t i = 0; i < 2; i++)
    {
        EXPECT_EQ(whole.cameras[i].model, back.cameras[i].model);
        EXPECT_EQ(whole.cameras[i].size, back.cameras[i].size);
        EXPECT_EQ(whole.cameras[i].parameters, back.cameras[i].parameters);
    }
    EXPECT_EQ(500, back.keypoints);
    EXPECT_TRUE(equal(whole.codes, back.codes));
    EXPECT_TRUE(equal(whole.sees, back.sees));
    EXPECT_TRUE(equal(whole.points, back.points));
    EXPECT_EQ(cv::Point3d(.1, 1, 6), back.point(2));
    ASSERT_EQ(3u, back.views.size());
    for (size_t i = 0; i < 3; i++)
    {
        EXPECT_EQ(whole.views[i].rows, back.views[i].rows);
        EXPECT_EQ(whole.views[i].centre, back.views[i].centre);
        EXPECT_EQ(whole.views[i].direction, back.views[i].direction);
        EXPECT_EQ(whole.views[i].depth, back.views[i].depth);
    }
}

TEST_F(SmallMap, damaged_or_missing_files)
{
    EXPECT_EQ("it has no map.json", error());
    for (const auto& [file, content] : files)
    {
        const std::string path = map + "/" + file, missing = path + " is missing or damaged";
        writeFiles(map, files, whole);
        std::string damaged = content;
        damaged.back() ^= 1;
        folder.write("map/" + file, damaged);
        EXPECT_EQ(path + " is damaged", error());
        for (size_t size = 0; size < content.size(); size += 3)
        {
            folder.write("map/" + file, content.substr(0, size));
            EXPECT_EQ(missing, error()) << size;
        }
        folder.write("map/" + file, content + ' ');
        EXPECT_EQ(missing, error());
        ASSERT_EQ(0, std::remove(path.c_str()));
        EXPECT_EQ(missing, error());
        // The sums say nothing of a file that was written wrongly.
        Files wrong = files;
        for (size_t i : {0, 6, 8, 22, 24, 45, 61})
        {
            wrong[file][i]++;
            writeFiles(map, wrong, whole);
            EXPECT_EQ(missing, error()) << i;
            wrong[file] = content;
        }
    }
    for (const char* text : {"", "{\"format\": 2"})
    {
        folder.write("map/map.json", text);
        EXPECT_EQ("map.json is damaged", error()) << text;
    }
    folder.write("map/map.json", "{\"format\": 2}");
    EXPECT_EQ(map + "/codes.npy is damaged", error()) << "has no sum";
    folder.write("map/map.json", "{\"format\": 1}");
    EXPECT_EQ("its format is not that of this version: make it again", error());
}

TEST_F(SmallMap, files_that_contradict_each_other)
{
    const auto errorOf = [&](const auto& change) {
        Map wrong = smallMap();
        change(wrong);
        writeMap(map, wrong);
        return error();
    };
    const std::string said = "its files contradict each other";
    EXPECT_EQ(said, errorOf([](Map& m) { m.keypoints = 0; }));
    EXPECT_EQ(said, errorOf([](Map& m) { m.views[2].rows.end = 4; }));
    EXPECT_EQ(said, errorOf([](Map& m) { m.views[2].rows.start = 3; }));
    EXPECT_EQ(said, errorOf([](Map& m) { m.views[2].rows = {1, INT_MAX}; }));
    EXPECT_EQ(said, errorOf([](Map& m) { m.views[0].rows.end = -1; }));
    EXPECT_EQ(said, errorOf([](Map& m) { m.sees.at<int>(1) = 3; }));
    EXPECT_EQ(said, errorOf([](Map& m) { m.sees.at<int>(1) = -1; }));
    EXPECT_EQ(said, errorOf([](Map& m) { m.sees.pop_back(); }));
    EXPECT_EQ(said, errorOf([](Map& m) { m.points = m.points.reshape(1, 9); }));
    Map wrong = smallMap();
    wrong.views.pop_back();
    writeFiles(map, files, wrong);
    EXPECT_EQ(said, error());
}

}  // namespace
