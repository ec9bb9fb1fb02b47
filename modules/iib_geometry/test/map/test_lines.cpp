// SPDX-License-Identifier: Apache-2.0

#include "map/lines.hpp"
#include "../wall.hpp"

// The source as compiled without OpenCV's module line_descriptor.
#undef IIB_LINE_DESCRIPTOR
namespace without_line_descriptor {
namespace cv {
using namespace ::cv;
namespace iib {
using namespace ::cv::iib;
Segments findSegments(const Picture&);
}  // namespace iib
}  // namespace cv
#include "../../src/map/segments.cpp"
}  // namespace without_line_descriptor

namespace opencv_test { namespace {
using namespace cv::iib;

std::string missing()
{
    return messageOf([] { findSegments(Picture()); });
}

double distance(const cv::Point3d& point, const MapLine& line)
{
    const cv::Point3d along = line.end - line.begin;
    return cv::norm((point - line.begin).cross(along)) / cv::norm(along);
}

//! Lines seen by four cameras along a wall, with noise of .2 pixels and one wrong bit in each code.
class Lines : public testing::Test
{
protected:
    Lines()
    {
        for (int i = 0; i < 40; i++)
        {
            const cv::Point3d middle = anyPoint();
            const double z = random.uniform(-.3, .3), y = random.uniform(.2, .5), x = random.uniform(-.3, .3);
            const cv::Point3d half(x, y, z);
            truth.push_back({middle - half, middle + half});
        }
        codes.create(int(truth.size()), 32, CV_8U);
        random.fill(codes, cv::RNG::UNIFORM, 0, 256);
    }

    cv::Point3d anyPoint()
    {
        const double z = random.uniform(3., 5.), y = random.uniform(-.8, .8), x = random.uniform(-1., 1.);
        return {x, y, z};
    }

    cv::Point2d anyError(double pixels)
    {
        const double y = random.gaussian(pixels), x = random.gaussian(pixels);
        return {x, y};
    }

    void add(double sideways)
    {
        std::vector<Segments> segments;
        for (int i = 0; i < 4; i++)
        {
            map.images.emplace_back();
            map.images[size_t(i)].camera = CAMERA;
            map.images[size_t(i)].cameraFromWorld =
                    inverse(poseAt(0.4 * i - 0.6, sideways * (i % 2), sideways * .2 * i));
            segments.push_back(seenFrom(map.images[size_t(i)].cameraFromWorld));
        }
        addLines(map, segments, {{0, 1}, {1, 2}, {2, 3}, {0, 2}, {1, 3}, {0, 3}});
    }

    Segments seenFrom(const cv::Affine3d& cameraFromWorld)
    {
        const auto off = [&] { return anyError(.2); };
        Segments segments;
        segments.codes = codes.clone();
        for (const MapLine& line : truth)
        {
            const auto ends = CAMERA.project({cameraFromWorld * line.begin, cameraFromWorld * line.end});
            segments.codes.at<uchar>(int(segments.places.size()), random.uniform(0, 32)) ^= 1;
            segments.places.push_back({ends[0] + off(), ends[1] + off()});
        }
        return segments;
    }

    cv::RNG random{7};
    Map map;
    std::vector<MapLine> truth;
    cv::Mat codes;
};

TEST_F(Lines, are_triangulated)
{
    add(.15);
    EXPECT_GE(map.lines.size(), 36u);
    size_t sights = 0;
    for (const MapImage& image : map.images)
    {
        sights += image.lines.size();
        cv::Mat_<int> bits, nearest;
        cv::batchDistance(image.lineCodes, codes, bits, CV_32S, nearest, cv::NORM_HAMMING, 1);
        ASSERT_EQ(image.lines.size(), bits.total());
        for (int row = 0; row < bits.rows; row++)
        {
            const MapLine &made = map.lines[size_t(image.lines[size_t(row)])],
                          &line = truth[size_t(nearest(row))];
            EXPECT_LT(std::max(distance(made.begin, line), distance(made.end, line)), .06) << nearest(row);
            EXPECT_LT(std::max(cv::norm(made.begin - line.begin), cv::norm(made.end - line.end)), .1);
        }
    }
    EXPECT_GE(sights, 3 * map.lines.size()) << "one line where several images see it";
}

TEST_F(Lines, along_the_path_have_no_depth)
{
    truth.resize(2);
    truth[0] = {{-.5, .4, 3.9}, {.5, .4, 4.1}};
    codes.resize(2);
    add(0);
    ASSERT_EQ(1u, map.lines.size());
    EXPECT_LT(distance(map.lines[0].begin, truth[1]), .06);
}

TEST_F(Lines, improve_poses_of_few_points)
{
    add(.15);
    double errors[2] = {0, 0};
    const Lens lens(CAMERA);
    const Frame frame({Match{{}, {0, 0, 0}}, Match{{}, {0, 0, 1}}, Match{{}, {0, 0, -1}}});  // identity
    for (int trial = 0; trial < 20; trial++)
    {
        const double z = random.uniform(-.1, .1), y = random.uniform(-.1, .1), x = random.uniform(-.5, .5);
        const cv::Affine3d pose = poseAt(x, y, z);
        std::vector<Match> matches;
        for (int i = 0; i < 8; i++)
        {
            const cv::Point3d point = anyPoint();
            const cv::Point2d off = anyError(1);
            matches.push_back({CAMERA.project({inverse(pose) * point})[0] + off, point});
        }
        cv::Affine3d found = inverse(pose);
        cv::Matx66d covariance, withLines;
        ASSERT_TRUE(refinePose(matches, lens, found, covariance));
        errors[0] += cv::norm(inverse(found).translation() - pose.translation());
        const std::vector<Match> ends =
                lineMatches(map, {0, 1, 2, 3}, seenFrom(inverse(pose)), lens, frame, found, 10);
        EXPECT_GT(ends.size(), 40u);
        EXPECT_LE(ends.size(), 2 * map.lines.size());
        matches.insert(matches.end(), ends.begin(), ends.end());
        ASSERT_TRUE(refinePose(matches, lens, found, withLines));
        EXPECT_LT(cv::trace(withLines.get_minor<3, 3>(0, 0)), cv::trace(covariance.get_minor<3, 3>(0, 0)));
        errors[1] += cv::norm(inverse(found).translation() - pose.translation());
    }
    EXPECT_LT(errors[1], .5 * errors[0]);
}

TEST_F(Lines, match_segments_that_overlap)
{
    const Lens lens(CAMERA);
    const auto ends = [&](const MapLine& line, const Segment& segment) {
        return matchesOf(line, segment, lens, cv::Affine3d(), 2);
    };
    const MapLine line = {{.5, .5, -2}, {.5, .5, 6}};  // begins behind the camera
    const cv::Point2d middle(160, 120), off(3, -3), last = CAMERA.project({line.end})[0];
    const Segment segment = {middle + 5 * (last - middle), last};
    const std::vector<Match> both = ends(line, segment);
    ASSERT_EQ(2u, both.size());
    for (const Match& m : both)
        EXPECT_LT(cv::norm(CAMERA.project({m.point})[0] - m.pixel), 1e-6);
    EXPECT_TRUE(ends(line, {segment.end, segment.begin}).empty()) << "the other side is brighter";
    EXPECT_TRUE(ends(line, {segment.begin + off, segment.end + off}).empty()) << "beside the line";
    EXPECT_TRUE(ends({{.5, .5, 8}, {.5, .5, 20}}, segment).empty()) << "beyond the segment";
    EXPECT_TRUE(ends({line.begin, {.5, .5, -1}}, segment).empty()) << "behind the camera";
    const MapLine flat = {{-.5, .1, 4}, {.5, .3, 5}};
    const auto seen = CAMERA.project({flat.begin, flat.end});
    const std::vector<Match> exact = ends(flat, {seen[0], seen[1]});
    ASSERT_EQ(2u, exact.size());
    for (const Match& m : exact)
    {
        EXPECT_LT(cv::norm(m.errorProjection * (seen[1] - seen[0])), 1e-6) << "errors along it do not count";
        EXPECT_NEAR(1, cv::trace(m.errorProjection), 1e-9) << "errors across it count";
    }
}

typedef WallTest LinesOfMaps;

TEST_F(LinesOfMaps, that_are_missing_are_reported)
{
    const std::string message = messageOf([] { without_line_descriptor::cv::iib::findSegments(Picture()); });
    EXPECT_EQ("this library was built without OpenCV's module line_descriptor, which lines need: install "
              "opencv_contrib (on Debian and Ubuntu: libopencv-contrib-dev) and build again",
            message)
            << "commands know this message";
    EXPECT_EQ(missing().empty() ? "the map has no lines: make it with lines, or localize without lines"
                                : message,
            messageOf([&] { Localizer(folder.path("map"), 1000, true); }));
}

TEST_F(LinesOfMaps, are_on_the_wall_and_refine_poses)
{
    if (!missing().empty())
        throw SkipTestException("OpenCV's module line_descriptor is not installed");
    const Wall posters(3, 40);
    MapOptions options(100);  // few points, so that lines have an effect
    options.lines = true;
    const std::string made = folder.path("lines");
    write(model(1, 40));
    buildMap(
            folder.path("sparse 0"),
            [&](const std::string& name) {
                const int i = name[name.size() - 5] - '0';
                return i < 6 ? posters.image(pathPose(i)) : cv::Mat();
            },
            made, options);
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
        EXPECT_LT(cv::norm(centre(after) - truth.translation()), .01);
        EXPECT_LT(after.covariance(0, 0), .98 * before.covariance(0, 0));
    }
    MapUpdate update(made);  // keeps the lines
    update.add("a", posters.image(poseAt(0, -.1, 0)) * .3, CAMERA);
    update.commit();
    EXPECT_EQ(lined.lines.size(), readMap(made).lines.size());
}

}}  // namespace opencv_test
