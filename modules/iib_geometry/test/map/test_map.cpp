// SPDX-License-Identifier: Apache-2.0

#include <atomic>
#include <filesystem>
#include <fstream>
#include <thread>

#include "map/colmap_model.hpp"
#include "../wall.hpp"
#include "opencv2/iib/detail/checked_file.hpp"

namespace opencv_test { namespace {
using namespace cv::iib;

Map smallMap()
{
    Map map;
    map.keypoints = 500;
    map.updates = 3;
    map.points = {{0, 0, 5}, {1, 0, 5}, {.1, 1, 6}};
    const Camera cameras[] = {
            {"PINHOLE", {640, 480}, {500, 500, 320, 240.5}}, {"FOV", {64, 48}, {50, 50, 32, 24, .5}}};
    const std::vector<std::vector<int>> sees = {{0, 2}, {}, {1}};
    for (int i = 0; i < 3; i++)
    {
        MapImage image;
        image.name = "a b/" + std::to_string(i) + ".png";
        image.camera = cameras[i / 2];
        image.cameraFromWorld = cv::Affine3d(cv::Vec3d(.1 * i, .2, .3), cv::Vec3d(1, 2, i));
        image.sees = sees[size_t(i)];
        for (size_t k = 0; k < image.sees.size(); k++)
        {
            image.pixels.emplace_back(20 + 10. * double(k), 30.25);
            image.sizes.push_back(float(7 + k));
        }
        image.misses.assign(image.sees.size(), uchar(i));
        image.codes.create(int(image.sees.size()), 128, CV_8U);
        if (!image.codes.empty())
            cv::RNG(uint64(i) + 1).fill(image.codes, cv::RNG::UNIFORM, 0, 256);
        image.used = 2;
        image.added = i == 2;
        if (i < 2)
            image.picture = pictureOf(cv::Mat(48 + i, 64, CV_8U, cv::Scalar(7 + i)));
        map.images.push_back(image);
    }
    map.lines = {{{1, 2, 3}, {4, 5, 6}}, {{-1, 0, 1e-9}, {7, 8, 9}}};
    map.images[1].lines = {1, 0};
    map.images[1].lineCodes = cv::Mat(2, 32, CV_8U, cv::Scalar(7));
    return map;
}

struct SmallMap : public testing::Test
{
    SmallMap() : name(folder.path("map")) {}

    void write(const Map& map) const { MapFolder(name).write(map); }
    std::string error() const
    {
        return messageOf([&] { readMap(name); });
    }

    //! Expects that no map is written into the folder while it holds any of these files.
    void expectRefusedWith(const std::vector<std::string>& files) const
    {
        for (const std::string& file : files)
        {
            folder.write("map/" + file, "precious");
            EXPECT_EQ(name + " holds " + file + ", which no earlier run wrote: choose another folder",
                    messageOf([&] { write(smallMap()); }));
            std::filesystem::remove(name + "/" + file);
        }
    }

    const TestFolder folder;
    const std::string name;
};

bool equal(const cv::Mat& a, const cv::Mat& b)
{
    return a.empty() ? b.empty() : a.size() == b.size() && cv::norm(a, b, cv::NORM_INF) == 0;
}

TEST_F(SmallMap, read_as_written)
{
    const Map map = smallMap();
    write(map);
    const Map back = readMap(name);
    EXPECT_EQ(500, back.keypoints);
    EXPECT_EQ(3u, back.updates);
    EXPECT_EQ(map.points, back.points);
    ASSERT_EQ(3u, back.images.size());
    for (size_t i = 0; i < 3; i++)
    {
        const MapImage &a = map.images[i], &b = back.images[i];
        EXPECT_EQ(0u, indexOf(a.camera, {b.camera}));
        EXPECT_EQ(a.cameraFromWorld.matrix, b.cameraFromWorld.matrix);
        EXPECT_TRUE(std::tie(a.name, a.pixels, a.sees, a.sizes, a.misses, a.used, a.added, a.lines) ==
                    std::tie(b.name, b.pixels, b.sees, b.sizes, b.misses, b.used, b.added, b.lines));
        EXPECT_EQ(a.codes.size(), b.codes.size());
        EXPECT_TRUE(equal(a.picture.pixels, b.picture.pixels) && equal(a.codes, b.codes) &&
                    equal(a.lineCodes, b.lineCodes));
    }
    ASSERT_EQ(2u, back.lines.size());
    EXPECT_EQ(map.lines[1].begin, back.lines[1].begin);
    EXPECT_EQ(map.lines[0].end, back.lines[0].end);
    EXPECT_EQ(2u, camerasOf(back.images).size());
    Map plain = smallMap();
    plain.lines.clear();
    plain.images[1].lines.clear();
    plain.images[1].lineCodes.release();
    write(plain);
    EXPECT_EQ(1, textOf(name + "/map.iib")[8]) << "without lines it is one that earlier programs read";
}

// The shorter side of a reduced picture was rounded, so the scale must come from the longer side.
TEST_F(SmallMap, pictures_of_portraits_keep_their_scale)
{
    Map map = smallMap();
    map.images[0].camera = map.images[1].camera = {"PINHOLE", {4000, 6000}, {5000, 5000, 2000, 3000}};
    for (int i = 0; i < 2; i++)
        map.images[size_t(i)].picture = pictureOf(cv::Mat(6000, 4000, CV_8U, cv::Scalar(7)));
    write(map);
    EXPECT_DOUBLE_EQ(1024. / 6000, map.images[0].picture.scale);
    EXPECT_DOUBLE_EQ(1024. / 6000, readMap(name).images[0].picture.scale);
}

TEST_F(SmallMap, every_altered_byte_and_every_length_is_noticed)
{
    write(smallMap());
    const std::string whole = textOf(name + "/map.iib"),
                      begin = name + "/map.iib cannot be read as a map of opencv_iib: ";
    // In place, since rewriting the file would wait for the disk.
    std::fstream file(name + "/map.iib", std::ios::in | std::ios::out | std::ios::binary);
    for (size_t i = 0; i < whole.size(); i++)
    {
        file.seekp(std::streamoff(i)).put(char(whole[i] ^ 4)).flush();
        EXPECT_EQ(0u, error().find(begin)) << "byte " << i;
        file.seekp(std::streamoff(i)).put(whole[i]).flush();
    }
    EXPECT_EQ("", error());
    file.seekp(0, std::ios::end).put(' ');
    file.close();
    for (size_t size = whole.size() + 2; size-- > 0;)
    {
        std::filesystem::resize_file(name + "/map.iib", size);
        EXPECT_EQ(size == whole.size() ? std::string::npos : 0, error().find(begin)) << size << " bytes";
    }
}

TEST_F(SmallMap, contradictions_with_a_right_checksum_are_noticed)
{
    write(smallMap());
    const auto errorOf = [&](const auto& change) {
        Map wrong = smallMap();
        change(wrong);
        writeMap(name, wrong, [] {});
        return error().substr(
                name.size() + std::string("/map.iib cannot be read as a map of opencv_iib: ").size());
    };
    EXPECT_EQ("it has no images", errorOf([](Map& m) { m.keypoints = 0; }));
    EXPECT_EQ("it has no images", errorOf([](Map& m) { m.images.clear(); }));
    EXPECT_EQ("its images have no codes", errorOf([](Map& m) {
        for (MapImage& image : m.images)
            image.codes = image.codes.colRange(0, 0).clone();
    }));
    EXPECT_EQ("two images have one name", errorOf([](Map& m) { m.images[1].name = m.images[0].name; }));
    EXPECT_EQ("a keypoint is invalid", errorOf([](Map& m) { m.images[2].sees[0] = -1; }));
    EXPECT_EQ("an image has no camera or no pose",
            errorOf([](Map& m) { m.images[2].cameraFromWorld.matrix(0, 0) = 2; }));
    EXPECT_EQ("an image refers to a missing line", errorOf([](Map& m) { m.images[1].lines[0] = 2; }));
    EXPECT_EQ("it has a NaN or infinite number", errorOf([](Map& m) { m.points[1].x = std::nan(""); }));

    write(smallMap());
    std::string bytes = textOf(name + "/map.iib");
    bytes[bytes.find(smallMap().images[0].name) + smallMap().images[0].name.size()] = 7;  // its camera
    Fnv1a hash;
    hash.add(bytes.data(), bytes.size() - 8);
    for (size_t i = 0; i < 8; i++)
        bytes[bytes.size() - 8 + i] = char(hash.value() >> 8 * i);
    folder.write("map/map.iib", bytes);
    EXPECT_NE(std::string::npos, error().find("an image has no camera or no pose")) << error();
}

TEST_F(SmallMap, other_folders_are_refused)
{
    EXPECT_EQ(name + " is no map: it has no map.iib", error());
    folder.makeFolder("map");
    folder.write("map/map.json", "{}");
    EXPECT_EQ(name + " is a map of an earlier version: make it again, in another folder", error());
    expectRefusedWith({"map.json", "codes.npy", "frames.bin"});  // not files of this version
    folder.write("map/map.iib.1-0.tmp", "of a killed process");
    folder.write("map/.DS_Store", "of a file manager");
    write(smallMap());
    std::filesystem::remove(name + "/.DS_Store");
    EXPECT_EQ("", error()) << "is replaced";
    EXPECT_FALSE(cv::utils::fs::exists(name + "/map.iib.1-0.tmp"));
    EXPECT_TRUE(cv::utils::fs::exists(name + "/points3D.bin"));
    const std::string before = textOf(name + "/map.iib");
    expectRefusedWith(
            {"thesis.tex", "points.npy", "map.iib.notes.tmp"});  // the second was one of earlier versions
    folder.makeFolder("sparse");
    folder.write("sparse/cameras.bin", "precious");
    EXPECT_EQ(folder.path("sparse") + " holds cameras.bin, which no earlier run wrote: choose another folder",
            messageOf([&] { MapFolder other(folder.path("sparse")); }));
    folder.write("file", "precious");
    EXPECT_NE("", messageOf([&] { MapFolder other(folder.path("file")); }));
    EXPECT_EQ("precious", textOf(folder.path("file")));
    EXPECT_EQ(before, textOf(name + "/map.iib"));
}

TEST_F(SmallMap, one_process_writes_at_a_time_and_new_files_stay)
{
    {
        const MapFolder made(name);
        expectAnotherWrites(name, [&] { MapFolder other(name); });
    }
    EXPECT_FALSE(cv::utils::fs::exists(name)) << "nothing was written";
    const MapFolder made(name);
    folder.write("map/thesis.tex", "precious");
    folder.write("map/points.npy", "precious");
    made.write(smallMap());
    EXPECT_EQ(3u, readMap(name).images.size());
    for (const char* file : {"/thesis.tex", "/points.npy"})
        EXPECT_EQ("precious", textOf(name + file));
}

TEST_F(SmallMap, links_are_followed)
{
    std::error_code refused;
    std::filesystem::create_symlink("nothing", folder.path("first"), refused);
    if (refused)
        throw SkipTestException("this system, or its user, makes no links: " + refused.message());
    folder.makeFolder("disk");
    for (const char* link : {"there", "new/"})
    {
        const std::string path = folder.path(link), bare = path.substr(0, path.find_last_not_of('/') + 1);
        std::filesystem::create_symlink("disk/" + bare.substr(bare.rfind('/') + 1), bare);
        MapFolder(path).write(smallMap());
        EXPECT_TRUE(std::filesystem::is_symlink(bare));
        EXPECT_EQ(3u, readMap(bare).images.size());
    }
    std::filesystem::create_symlink("circle", folder.path("circle"));
    EXPECT_NE("", messageOf([&] { MapFolder other(folder.path("circle")); }));
}

TEST_F(SmallMap, an_unreadable_model_is_not_written)
{
    folder.makeFolder("map");
    const auto errorOf = [&](const auto& change) {
        std::vector<PosedImage> images = {smallMap().images[0], smallMap().images[1]};
        std::vector<cv::Point3d> points = smallMap().points;
        change(images, points);
        return messageOf([&] { writeModel(name, images, points); });
    };
    typedef std::vector<PosedImage> Images;
    typedef std::vector<cv::Point3d> Points;
    EXPECT_EQ("", errorOf([](Images&, Points&) {}));
    EXPECT_EQ(2u, readModel(name).size());
    const std::string before = textOf(name + "/images.bin");
    EXPECT_EQ("a keypoint of image a b/0.png sees point 2 of 2 points",
            errorOf([](Images&, Points& p) { p.resize(2); }));
    EXPECT_EQ("a model needs at least one image", errorOf([](Images& i, Points&) { i.clear(); }));
    EXPECT_EQ("image a b/0.png is there twice: names must be distinct",
            errorOf([](Images& i, Points&) { i[1].name = i[0].name; }));
    EXPECT_EQ("an image has no name: give it one", errorOf([](Images& i, Points&) { i[1].name.clear(); }));
    EXPECT_EQ("the name of an image, 'a...', has a zero byte, which ends names in COLMAP's files",
            errorOf([](Images& i, Points&) { i[1].name = std::string("a\0b", 3); }));
    EXPECT_EQ("image a b/0.png has a pose that is not finite",
            errorOf([](Images& i, Points&) { i[0].cameraFromWorld.matrix(1, 3) = std::nan(""); }));
    for (const cv::Matx33d& change : {cv::Matx33d::eye() * 1.01, cv::Matx33d(-1, 0, 0, 0, 1, 0, 0, 0, 1),
                 cv::Matx33d(1, .01, 0, 0, 1, 0, 0, 0, 1)})
        EXPECT_EQ("image a b/0.png has a pose that scales, shears or mirrors: give a rotation and a "
                  "translation",
                errorOf([&](Images& i, Points&) {
                    i[0].cameraFromWorld.rotation(change * i[0].cameraFromWorld.rotation());
                }));
    EXPECT_EQ("image a b/0.png has a camera of 70000 x 480 pixels: at most 65535 a side",
            errorOf([](Images& i, Points&) {
                i[0].camera = {"PINHOLE", {70000, 480}, {500, 500, 320, 240}};
            }));
    EXPECT_EQ("image a b/0.png has a keypoint that is not finite",
            errorOf([](Images& i, Points&) { i[0].pixels[0].x = HUGE_VAL; }));
    EXPECT_EQ("image a b/0.png has 2 keypoints, but 3 indices of their points",
            errorOf([](Images& i, Points&) { i[0].sees.push_back(0); }));
    EXPECT_EQ(
            "a point of the model is not finite", errorOf([](Images&, Points& p) { p[0].z = std::nan(""); }));
    EXPECT_EQ(before, textOf(name + "/images.bin"));
}

TEST_F(SmallMap, all_files_of_a_model_are_replaced_or_none)
{
    folder.makeFolder("map");
    const Map map = smallMap();
    const auto write = [&](size_t count) {
        const std::vector<PosedImage> images(map.images.begin(), map.images.begin() + count);
        return messageOf([&] { writeModel(name, images, map.points); });
    };
    EXPECT_EQ("", write(2));
    std::filesystem::remove(name + "/points3D.bin");
    std::filesystem::create_directory(name + "/points3D.bin");
    EXPECT_EQ("Cannot write " + name + "/points3D.bin: it is a folder, a device or a pipe", write(1));
    EXPECT_EQ(2u, readModel(name).size());
    EXPECT_EQ(3,
            std::distance(std::filesystem::directory_iterator(name), std::filesystem::directory_iterator()));
}

//! A locale with a decimal comma and grouped digits, on every machine.
struct CommaForPoint : std::numpunct<char>
{
    char do_decimal_point() const override { return ','; }
    char do_thousands_sep() const override { return '.'; }
    std::string do_grouping() const override { return "\3"; }
};

TEST_F(SmallMap, text_models_do_not_depend_on_the_locale)
{
    folder.makeFolder("map");
    folder.write("map/cameras.txt", "1 PINHOLE 64 48 50.5 50.25 32 24\n");
    folder.write("map/images.txt", "1 1 0 0 0 .5 -.25 1e-1 1 a.png\n12.75 1234.5 -1\n");
    const std::locale before = std::locale::global(std::locale(std::locale(), new CommaForPoint));
    std::vector<PosedImage> images;
    const std::string error = messageOf([&] { images = readModel(name); });
    std::locale::global(before);
    ASSERT_EQ("", error);
    EXPECT_EQ(std::vector<double>({50.5, 50.25, 32, 24}), images[0].camera.parameters);
    EXPECT_EQ(cv::Vec3d(.5, -.25, .1), images[0].cameraFromWorld.translation());
    EXPECT_EQ(cv::Point2d(12.25, 1234), images[0].pixels[0]);
}

TEST_F(SmallMap, names_in_any_language)
{
    const std::string other = name + " \xc3\xa9\xe6\xbc\xa2\xd0\xb6";  // in no code page of Windows
    MapFolder(other).write(smallMap());
    EXPECT_EQ(3u, readMap(other).images.size());
    EXPECT_EQ(3u, readModel(other).size());
}

TEST_F(SmallMap, a_reader_gets_one_of_two_maps_that_replace_each_other)
{
    Map maps[] = {smallMap(), smallMap()};
    maps[1].images.pop_back();
    maps[1].updates = 4;
    const MapFolder target(name);
    target.write(maps[0]);
    std::atomic<bool> over(false);
    std::thread writer([&] {
        for (int i = 0; i < 100; i++)
            target.write(maps[i % 2]);
        over = true;
    });
    while (!over)
    {
        Map read;
        EXPECT_EQ("", messageOf([&] { read = readMap(name); }));
        EXPECT_EQ(read.updates == 3 ? 3u : 2u, read.images.size());
    }
    writer.join();
}

}}  // namespace opencv_test
