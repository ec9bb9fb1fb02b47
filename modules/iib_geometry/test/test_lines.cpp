// SPDX-License-Identifier: Apache-2.0

#include <numeric>

#include "lines.hpp"
#include "opencv2/core/hal/hal.hpp"
#include "wall.hpp"

// The same file as in a build without OpenCV's module line_descriptor.
#undef IIB_LINE_DESCRIPTOR
namespace without_line_descriptor {
namespace iib_localization {
using namespace ::iib_localization;
void needLines();
Segments findSegments(const Picture&);
int codeDistance(const cv::Mat&, int, const cv::Mat&, int);
}  // namespace iib_localization
#include "../src/segments.cpp"
}  // namespace without_line_descriptor

namespace opencv_test {
namespace {
using namespace iib_localization;
using cv::iib::Localizer;
using cv::iib::Location;
using cv::iib::MapOptions;

bool haveLines() { return messageOf(needLines).empty(); }

//! Lines before cameras along a wall, and what these see of them.
class LineMapping : public testing::Test
{
protected:
    LineMapping() : random(7)
    {
        for (int i = 0; i < 4; i++)
        {
            map.images.emplace_back();
            map.images.back().camera = CAMERA;
            map.images.back().cameraFromWorld = inverse(poseAt(0.4 * i - 0.6, 0.15 * (i % 2), 0.03 * i));
        }
        for (int i = 0; i < 40; i++)
        {
            const cv::Point3d middle(uniform(-1, 1), uniform(-.8, .8), uniform(3, 5)),
                    half(uniform(-.3, .3), uniform(.2, .5), uniform(-.3, .3));
            truth.push_back({middle - half, middle + half});
        }
        codes.create(int(truth.size()), 32, CV_8U);
        random.fill(codes, cv::RNG::UNIFORM, 0, 256);
    }

    double uniform(double from, double to) { return random.uniform(from, to); }

    //! What a camera sees of the lines, some pixels of noise off, with a bit of each code wrong.
    Segments seenFrom(const cv::Affine3d& cameraFromWorld, double noise)
    {
        Segments segments;
        for (const MapLine& line : truth)
        {
            const cv::Point2d off(random.gaussian(noise), random.gaussian(noise)),
                    off2(random.gaussian(noise), random.gaussian(noise));
            const std::vector<cv::Point2d> ends =
                    CAMERA.project({cameraFromWorld * line.begin, cameraFromWorld * line.end});
            segments.places.push_back({ends[0] + off, ends[1] + off2});
        }
        segments.codes = codes.clone();
        for (int i = 0; i < codes.rows; i++)
            segments.codes.at<uchar>(i, random.uniform(0, 32)) ^= 1;
        return segments;
    }

    void add(double noise)
    {
        std::vector<Segments> segments;
        for (const MapImage& image : map.images)
            segments.push_back(seenFrom(image.cameraFromWorld, noise));
        addLines(map, segments, {{0, 1}, {1, 2}, {2, 3}, {0, 2}, {1, 3}, {0, 3}});
    }

    //! Distance of a point from a line of the world.
    static double distance(const cv::Point3d& point, const MapLine& line)
    {
        const cv::Point3d along = line.end - line.begin;
        return cv::norm((point - line.begin).cross(along)) / cv::norm(along);
    }

    cv::RNG random;
    Map map;
    std::vector<MapLine> truth;
    cv::Mat codes;
};

TEST_F(LineMapping, lines_are_where_they_are)
{
    add(.2);
    EXPECT_GE(map.lines.size(), 36u);
    size_t sights = 0;
    for (const MapImage& image : map.images)
    {
        ASSERT_EQ(image.lines.size(), size_t(image.lineCodes.rows));
        sights += image.lines.size();
        for (int row = 0; row < image.lineCodes.rows; row++)
        {
            int nearest = 0;
            for (int i = 1; i < codes.rows; i++)
                if (codeDistance(image.lineCodes, row, codes, i) <
                        codeDistance(image.lineCodes, row, codes, nearest))
                    nearest = i;
            const MapLine &made = map.lines[size_t(image.lines[size_t(row)])], &line = truth[size_t(nearest)];
            EXPECT_LT(distance(made.begin, line), .06) << nearest;
            EXPECT_LT(distance(made.end, line), .06) << nearest;
            EXPECT_LT(std::max(cv::norm(made.begin - line.begin), cv::norm(made.end - line.end)), .1);
        }
    }
    EXPECT_GE(sights, 3 * map.lines.size()) << "one line where several images see it";
}

TEST_F(LineMapping, a_line_in_one_plane_with_the_cameras_is_left_out)
{
    truth.resize(2);
    codes = codes.rowRange(0, 2).clone();
    for (size_t i = 0; i < map.images.size(); i++)  // on one path
        map.images[i].cameraFromWorld = inverse(poseAt(0.4 * double(i) - 0.6, 0, 0));
    truth[0] = {{-.5, .4, 3.9}, {.5, .4, 4.1}};  // along it
    add(.2);
    ASSERT_EQ(1u, map.lines.size());
    EXPECT_LT(distance(map.lines[0].begin, truth[1]), .06);
}

TEST_F(LineMapping, poses_of_few_points_are_better_with_lines)
{
    add(.2);
    double errors[2] = {0, 0};
    const Lens lens(CAMERA);
    std::vector<size_t> all(map.images.size());
    std::iota(all.begin(), all.end(), size_t(0));
    for (int trial = 0; trial < 20; trial++)
    {
        const cv::Affine3d pose = poseAt(uniform(-.5, .5), uniform(-.1, .1), uniform(-.1, .1));
        std::vector<Match> matches;
        for (int i = 0; i < 8; i++)
        {
            const cv::Point3d point(uniform(-1, 1), uniform(-.8, .8), uniform(3, 5));
            const cv::Point2d off(random.gaussian(1), random.gaussian(1));
            matches.push_back({CAMERA.project({inverse(pose) * point})[0] + off, point});
        }
        cv::Affine3d found = inverse(pose);
        cv::Matx66d covariance, withLines;
        ASSERT_TRUE(refinePose(matches, lens, found, covariance));
        errors[0] += cv::norm(inverse(found).translation() - pose.translation());
        const Frame frame(matches);
        cv::Affine3d local = found * cv::Affine3d(cv::Matx33d::eye(), frame.centre);
        local.translation(local.translation() * (1 / frame.unit));
        std::vector<Match> lines = lineMatches(map, all, seenFrom(inverse(pose), .2), lens, frame, local, 10);
        EXPECT_GT(lines.size(), 40u) << "two ends each";
        for (Match& m : lines)
            m.point = cv::Vec3d(m.point) * frame.unit + frame.centre;
        matches.insert(matches.end(), lines.begin(), lines.end());
        ASSERT_TRUE(refinePose(matches, lens, found, withLines));
        EXPECT_LT(cv::trace(withLines.get_minor<3, 3>(0, 0)), cv::trace(covariance.get_minor<3, 3>(0, 0)));
        errors[1] += cv::norm(inverse(found).translation() - pose.translation());
    }
    EXPECT_LT(errors[1], .5 * errors[0]);
}

TEST_F(LineMapping, part_of_a_line_behind_the_camera_is_cut_off)
{
    const Lens lens(CAMERA);
    const MapLine line = {{.5, .5, -2}, {.5, .5, 6}};
    const Segment segment = {{290, 250}, CAMERA.project({line.end})[0]};
    EXPECT_EQ(2u, SeenLine(line, lens, cv::Affine3d()).matchesWith(segment, 2).size());
    EXPECT_EQ(0u, SeenLine(line, lens, cv::Affine3d()).matchesWith({segment.end, segment.begin}, 2).size());
    EXPECT_EQ(
            0u, SeenLine({{.5, .5, -2}, {.5, .5, -1}}, lens, cv::Affine3d()).matchesWith(segment, 2).size());
}

TEST_F(LineMapping, a_missing_line_descriptor_is_told)
{
    const std::string told = messageOf(without_line_descriptor::iib_localization::needLines);
    EXPECT_NE(std::string::npos,
            told.find("install opencv_contrib (on Debian and Ubuntu: libopencv-contrib-dev)"));
    EXPECT_EQ(told, messageOf([] { without_line_descriptor::iib_localization::findSegments(Picture()); }));
}

class LinesOfMaps : public WallTest
{
protected:
    LinesOfMaps() : posters(3, 40) { write(model(1, 40)); }

    //! Of the wall with posters, in the order of the model's names.
    cv::iib::ImageReader pictures() const
    {
        return [this](const std::string& name) {
            const int i = name[name.size() - 5] - '0';
            return i < 6 ? posters.image(poseAt(0.3 * i - 0.8, 0.05 * (i % 2), 0.03 * i)) : cv::Mat();
        };
    }

    const Wall posters;
};

TEST_F(LinesOfMaps, are_saved_and_read_back)
{
    map.lines = {{{1, 2, 3}, {4, 5, 6}}, {{-1, 0, 1e-9}, {7, 8, 9}}};
    map.images[1].lines = {1, 0};
    map.images[1].lineCodes = cv::Mat(2, 32, CV_8U, cv::Scalar(7));
    map.images[4].lines = {1};
    map.images[4].lineCodes = cv::Mat(1, 32, CV_8U, cv::Scalar(9));
    map.orbAndAkaze = true;
    const std::string path = folder.path("lines");
    MapFolder(path).write(map);
    const Map back = readMap(path);
    EXPECT_TRUE(back.orbAndAkaze);
    ASSERT_EQ(2u, back.lines.size());
    EXPECT_EQ(map.lines[1].begin, back.lines[1].begin);
    EXPECT_EQ(map.lines[0].end, back.lines[0].end);
    EXPECT_EQ(map.images[1].lines, back.images[1].lines);
    EXPECT_EQ(0, cv::norm(map.images[4].lineCodes, back.images[4].lineCodes, cv::NORM_INF));
    EXPECT_TRUE(back.images[0].lines.empty());
    map.images[1].lines[0] = 2;
    MapFolder(path).write(map);
    EXPECT_NE(std::string::npos,
            messageOf([&] { readMap(path); }).find("an image sees a line that is not there"));
}

TEST_F(LinesOfMaps, a_map_without_is_one_of_version_1)
{
    EXPECT_EQ(1, textOf(folder.path("map/map.iib"))[8]) << "which earlier programs read";
    EXPECT_TRUE(readMap(folder.path("map")).lines.empty());
    EXPECT_EQ(
            haveLines() ? "the map has no lines: make it with lines, or look for none" : messageOf(needLines),
            messageOf([&] { Localizer(folder.path("map"), 1000, true); }));
}

TEST_F(LinesOfMaps, are_on_the_wall_and_refine_poses)
{
    if (!haveLines())
        throw SkipTestException("OpenCV's module line_descriptor is not installed");
    MapOptions options;
    options.lines = true;
    const std::string made = folder.path("lines");
    cv::iib::buildMap(folder.path("sparse 0"), pictures(), made, options);
    const Map lined = readMap(made);
    EXPECT_GT(lined.lines.size(), 12u);
    for (const MapLine& line : lined.lines)
        for (const cv::Point3d& p : {line.begin, line.end})
            EXPECT_LT(std::abs(p.z - .4 * p.x - 4), .1) << p;
    const Localizer points(made, 40), both(made, 40, true);
    for (int i = 0; i < 5; i++)
    {
        const cv::Affine3d truth = poseAt(0.16 * i - 0.4, -0.1, 0.02 * i);
        const cv::Mat image = posters.image(truth) * .5;
        const Location before = points.localize(image, CAMERA), after = both.localize(image, CAMERA);
        ASSERT_TRUE(before.found && after.found) << after.reason;
        EXPECT_LT(cv::norm(inverse(after.cameraFromWorld).translation() - truth.translation()), .01);
        EXPECT_LT(after.covariance(0, 0), .98 * before.covariance(0, 0));
    }
    cv::iib::MapUpdate update(made);  // keeps them
    update.add("a", posters.image(poseAt(0, -.1, 0)) * .3, CAMERA);
    update.commit();
    EXPECT_EQ(lined.lines.size(), readMap(made).lines.size());
}

#if CV_VERSION_MAJOR < 5
TEST_F(LinesOfMaps, points_of_orb_and_akaze)
{
    MapOptions options;
    options.orbAndAkaze = true;
    cv::iib::buildMap(folder.path("sparse 0"), images(), folder.path("paper"), options);
    const cv::Affine3d truth = poseAt(0.1, -0.1, 0.1);
    const Location location = Localizer(folder.path("paper")).localize(wall.image(truth) * .5, CAMERA);
    ASSERT_TRUE(location.found) << location.reason;
    EXPECT_LT(cv::norm(inverse(location.cameraFromWorld).translation() - truth.translation()), .02);
    EXPECT_EQ(170, readMap(folder.path("paper")).images[0].codes.cols) << "the default's";
}
#endif

}  // namespace
}  // namespace opencv_test
