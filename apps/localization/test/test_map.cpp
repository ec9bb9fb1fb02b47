// SPDX-License-Identifier: Apache-2.0

#include "map_writer.hpp"
#include "wall.hpp"

namespace {
using namespace iib_localization;

Map smallMap()
{
    Map map;
    map.points = 500;
    map.model.cameras[3] = {"PINHOLE", {640, 480}, {500, 500, 320, 240}};
    map.model.points = {{7, {0, 0, 5}}, {8, {1, 0, 5}}, {9, {0.1, 1, 6}}};
    cv::Mat codes(3, 128, CV_8U);
    cv::RNG(1).fill(codes, cv::RNG::UNIFORM, 0, 256);
    const cv::Affine3d pose(cv::Vec3d(0.1, -0.2, 0.3), cv::Vec3d(1, 2, 3));
    map.model.images = {
            {2, {"a b/c.png", pose, {7, 9}}}, {5, {"none.png", pose, {}}}, {6, {"b.png", pose, {8}}}};
    map.codes = {{2, codes.rowRange(0, 2)}, {5, cv::Mat(0, 128, CV_8U)}, {6, codes.rowRange(2, 3)}};
    return map;
}

TEST(Sha256, of_known_texts)
{
    // FIPS 180-2, appendix B; the third by Python's hashlib
    const TestFolder folder;
    folder.write("abc", "abc");
    folder.write("two", "abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq");
    folder.write("large", std::string(1 << 20, 'a'));
    EXPECT_EQ("ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad",
            sha256OfFile(folder.path("abc")));
    EXPECT_EQ("248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1",
            sha256OfFile(folder.path("two")));
    EXPECT_EQ("9bc1b2a288b26af7257a36277ae3816a7d4f16e89c1e7e77d0a5c48bad62b360",
            sha256OfFile(folder.path("large")));
    EXPECT_EQ("", sha256OfFile(folder.path("none")));
}

TEST(Map, read_as_written)
{
    const TestFolder folder;
    folder.makeFolder("map");
    const Map map = smallMap();
    writeMap(folder.path("map"), map);
    const Map back = readMap(folder.path("map"));
    EXPECT_EQ(map.model.points, back.model.points);
    EXPECT_EQ("PINHOLE", back.model.cameras.at(3).model);
    EXPECT_EQ(cv::Size(640, 480), back.model.cameras.at(3).size);
    EXPECT_EQ(map.model.cameras.at(3).parameters, back.model.cameras.at(3).parameters);
    EXPECT_EQ(500, back.points);
    ASSERT_EQ(3u, back.model.images.size());
    for (const auto& [id, image] : map.model.images)
    {
        const ModelImage& other = back.model.images.at(id);
        EXPECT_EQ(image.name, other.name);
        EXPECT_EQ(image.points, other.points);
        EXPECT_LT(cv::norm(image.cameraFromWorld.matrix - other.cameraFromWorld.matrix), 1e-12);
        const cv::Mat &codes = map.codes.at(id), &read = back.codes.at(id);
        ASSERT_EQ(codes.rows, read.rows);
        EXPECT_TRUE(codes.empty() || cv::countNonZero(codes != read) == 0);
    }
}

struct DamagedMap : public testing::Test
{
    DamagedMap() : map(folder.path("map")), whole(smallMap()), files(filesOf(whole))
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
    Map whole;
    Files files;
};

TEST_F(DamagedMap, files_that_are_altered_or_missing)
{
    EXPECT_EQ("it has no map.json", error());
    for (const auto& [file, content] : files)
    {
        writeFiles(map, files, whole);
        std::ofstream(map + "/" + file, std::ios::app) << " ";
        EXPECT_EQ(file + " is damaged", error());
        ASSERT_EQ(0, std::remove((map + "/" + file).c_str()));
        EXPECT_EQ(file + " is damaged", error());
    }
    for (const char* text : {"", "{\"format\": 1", "[1]", "{\"format\": 1}"})
    {
        folder.write("map/map.json", text);
        EXPECT_NE("", error()) << text;
    }
    folder.write("map/map.json", "{\"format\": 7}");
    EXPECT_EQ("its format is unknown to this version", error());
}

// The sums say nothing of a file that was written wrongly.
TEST_F(DamagedMap, files_that_are_cut_off_or_longer)
{
    for (const char* file : {"cameras.bin", "images.bin", "points3D.bin"})
    {
        const std::string content = files[file], path = map + "/" + file;
        for (size_t size = 0; size < content.size(); size += 3)
        {
            files[file] = content.substr(0, size);
            writeFiles(map, files, whole);
            EXPECT_EQ(0u, error().find(path)) << size;
        }
        files[file] = content + ' ';
        writeFiles(map, files, whole);
        EXPECT_EQ(path + " is longer than what it holds", error());
        files[file] = content;
        files[file][6] = '\x7f';  // says that more follows than memory can hold
        writeFiles(map, files, whole);
        EXPECT_EQ(path + " is cut off", error());
        files[file] = content;
    }
    files["codes.npy"].pop_back();
    writeFiles(map, files, whole);
    EXPECT_EQ(map + "/codes.npy: not as many bytes as its header says", error());
    files["codes.npy"] = npy("3, 32", std::string(96, ' ')).replace(22, 1, "f");  // |f1
    writeFiles(map, files, whole);
    EXPECT_EQ(map + "/codes.npy: not a two-dimensional array of uint8 in C order", error());
    for (const char* content : {"", "no array", "\x93NUMPY\x02"})
    {
        files["codes.npy"] = content;
        writeFiles(map, files, whole);
        EXPECT_EQ(map + "/codes.npy: not a readable .npy file", error());
    }
}

TEST_F(DamagedMap, contents_that_contradict_each_other)
{
    const auto errorOf = [&](const Map& wrong) {
        writeFiles(map, filesOf(wrong), wrong);
        return error();
    };
    Map wrong = whole;
    wrong.codes[2] = wrong.codes[2].rowRange(0, 1);
    EXPECT_EQ("image 2 has not a code for each point", errorOf(wrong));
    wrong = whole;
    wrong.model.images[6].points[0] = -1;
    EXPECT_EQ("b.png has a code without a point", errorOf(wrong));
    wrong = whole;
    wrong.model.points.erase(8);
    EXPECT_EQ(map + "/images.bin has a point that points3D.bin has not, in image b.png", errorOf(wrong));
    wrong = whole;
    wrong.codes.erase(6);
    writeFiles(map, files, wrong);
    EXPECT_EQ("it does not have the codes of its images", error());
    files["cameras.bin"][12] = 77;
    writeFiles(map, files, whole);
    EXPECT_EQ("there is no camera model of number 77", error());
}

TEST(Map, cameras_that_are_not_known_are_read)
{
    const TestFolder folder;
    folder.makeFolder("map");
    Files files = filesOf(smallMap());
    files["cameras.bin"][12] = 7;
    files["cameras.bin"] += bytes(0.5);  // of FOV
    writeFiles(folder.path("map"), files, smallMap());
    EXPECT_EQ("FOV", readMap(folder.path("map")).model.cameras.at(3).model);
}

}  // namespace
