// SPDX-License-Identifier: Apache-2.0

#include "../src/line_features.hpp"
#include "../src/line_mapping.hpp"
#include "../src/line_matching.hpp"
#include "opencv2/imgproc.hpp"
#include "opencv2/ts.hpp"

namespace {
using namespace iib_localization;

const Camera CAMERA = {"PINHOLE", {640, 480}, {500, 510, 320, 240}};
const Pinhole PINHOLE = CAMERA.pinhole();
const Pose POSE = {Eigen::Quaterniond(0.9, 0.1, -0.2, 0.1).normalized(), {1, -2, 0.5}};

TEST(LineFeatures, finds_edges_where_they_are)
{
    if (!linesAvailable())
        return;
    double sum = 0;
    int count = 0;
    for (double edge = 50; edge < 51; edge += 0.1)
    {
        // a bright right half, whose pixels tell where it begins, and a little blur
        cv::Mat image(100, 100, CV_8U, cv::Scalar(40));
        image.colRange(51, 100) = 200;
        image.col(int(std::lround(edge))) = 40 + 160 * (std::floor(edge + 0.5) + 0.5 - edge);
        if (std::lround(edge) == 50)
            image.col(51) = 200;
        else
            image.col(50) = 40;
        cv::GaussianBlur(image, image, {5, 5}, 0.8);
        const LineFeatures features = extractLines(image);
        ASSERT_EQ(1u, features.segments.size()) << edge;
        EXPECT_EQ(cv::Size(32, 1), features.codes.size());
        const Segment& s = features.segments[0];
        EXPECT_NEAR(edge, s.begin.x(), 0.3);
        EXPECT_GT(s.length(), 80);
        sum += s.begin.x() - edge;
        count++;
        cv::flip(image, image, 1);
        const Segment mirrored = extractLines(image).segments.at(0);
        EXPECT_LT((s.end - s.begin).y() * (mirrored.end - mirrored.begin).y(), 0)
                << "the brighter side decides the direction";
    }
    EXPECT_NEAR(0, sum / count, 0.05);
    EXPECT_TRUE(extractLines(cv::Mat(100, 100, CV_8U, cv::Scalar(7))).segments.empty());
}

// A line between two places of the image at two depths.
MapLine lineAt(const Segment& seen, double z1, double z2)
{
    return {POSE.toWorld(PINHOLE.ray(seen.begin) * z1), POSE.toWorld(PINHOLE.ray(seen.end) * z2), {}};
}

TEST(SeenAs, the_piece_beside_the_segment)
{
    const MapLine line = lineAt({{100, 100}, {500, 400}}, 3, 8);
    const Segment segment = {{180, 160}, {260, 220}};  // on it
    const auto seen = seenAs(line.begin, line.end, segment, PINHOLE, POSE, 1);
    ASSERT_TRUE(seen.has_value());
    EXPECT_LT((PINHOLE.project(POSE.toCamera(seen->begin)) - segment.begin).norm(), 1e-9);
    EXPECT_LT((PINHOLE.project(POSE.toCamera(seen->end)) - segment.end).norm(), 1e-9);
    EXPECT_LT((line.end - line.begin).normalized().cross(seen->end - line.begin).norm(), 1e-9);

    const auto found = [&](const Segment& s, double maxDistance) {
        return seenAs(line.begin, line.end, s, PINHOLE, POSE, maxDistance).has_value();
    };
    const Eigen::Vector2d aside(-3, 4);  // five pixels
    EXPECT_TRUE(found({segment.begin + aside, segment.end + aside}, 5.1));
    EXPECT_FALSE(found({segment.begin + aside, segment.end + aside}, 4.9));
    EXPECT_FALSE(found({segment.begin, segment.end + 2 * aside}, 20)) << "turned by 5.7 degrees";
    EXPECT_FALSE(found({segment.end, segment.begin}, 5)) << "the bright side is the other one";
    EXPECT_FALSE(found({{20, 40}, {106, 104.5}}, 5)) << "hardly any of it is beside";
}

TEST(SeenAs, a_line_that_passes_the_camera)
{
    // from a place in the image to one behind the camera
    const Eigen::Vector3d ahead = PINHOLE.ray({300, 250}) * 5, behind(0.4, 1.5, -1);
    const Eigen::Vector3d near = ahead + (behind - ahead) * 0.6;
    const Segment segment = {PINHOLE.project(ahead), PINHOLE.project(near)};
    const auto seen = seenAs(POSE.toWorld(ahead), POSE.toWorld(behind), segment, PINHOLE, POSE, 1);
    ASSERT_TRUE(seen.has_value());
    EXPECT_LT((POSE.toCamera(seen->end) - near).norm(), 1e-9);
    EXPECT_FALSE(seenAs(POSE.toWorld({0, 0, -5}), POSE.toWorld(behind), segment, PINHOLE, POSE, 1));
}

//! Segments of an image and lines of the world that are seen as them, with the same codes.
struct LineScene
{
    DescribedSegments image;
    std::vector<MapLine> lines;

    LineScene()
    {
        cv::RNG random(5);
        image.codes.create(40, 32, CV_8U);
        random.fill(image.codes, cv::RNG::UNIFORM, 0, 256);
        for (int i = 0; i < image.codes.rows; i++)
        {
            const Eigen::Vector2d begin(50 + 60 * (i % 8), 50 + 90 * (i / 8));
            const double angle = random.uniform(0., 2 * CV_PI);
            image.segments.push_back({begin, begin + 40 * Eigen::Vector2d(std::cos(angle), std::sin(angle))});
            lines.push_back(lineAt(image.segments.back(), random.uniform(3., 9.), random.uniform(3., 9.)));
        }
    }
    std::vector<Line3> described() const
    {
        std::vector<Line3> result;
        for (size_t i = 0; i < lines.size(); i++)
            result.push_back({lines[i].begin, lines[i].end, image.codes.ptr(int(i))});
        return result;
    }
    std::vector<LineObservation> match(const std::vector<Line3>& given, double maxDistance = 4) const
    {
        return matchLines(given, image, PINHOLE, POSE, maxDistance);
    }
};

TEST(MatchLines, finds_all_and_rejects_what_lies_elsewhere)
{
    LineScene scene;
    const std::vector<LineObservation> matches = scene.match(scene.described());
    ASSERT_EQ(scene.lines.size(), matches.size());
    for (size_t i = 0; i < matches.size(); i++)
    {
        EXPECT_EQ(scene.image.segments[i].begin, matches[i].segment.begin);
        EXPECT_LT((matches[i].begin - scene.lines[i].begin).norm(), 1e-9);
    }
    EXPECT_EQ(matches.size(), agreeing(matches, PINHOLE, POSE).size());
    EXPECT_LT(deviation(matches, PINHOLE, POSE), 1e-9);
    Pose turned = POSE;
    turned.rotation = POSE.rotation * Eigen::AngleAxisd(0.05, Eigen::Vector3d::UnitX());
    EXPECT_LT(agreeing(matches, PINHOLE, turned).size(), matches.size() / 4);

    // occluded: the other end and more of ten segments are not seen, which changes nothing; of ten, hardly anything is seen
    for (size_t i = 0; i < 20; i++)
    {
        Segment& s = scene.image.segments[i];
        s.end = s.begin + (i < 10 ? 0.5 : 0.2) * (s.end - s.begin);
    }
    EXPECT_EQ(30u, scene.match(scene.described()).size());
    // turned by a quarter, as wrong matches are
    for (size_t i = 20; i < 30; i++)
    {
        Segment& s = scene.image.segments[i];
        const Eigen::Vector2d v = s.end - s.begin;
        s.end = s.begin + Eigen::Vector2d(-v.y(), v.x());
    }
    EXPECT_EQ(20u, scene.match(scene.described()).size());
}

TEST(MatchLines, of_neighbouring_lines_the_codes_decide)
{
    LineScene scene;
    // each segment has a neighbour three pixels beside it, where the line would be seen; its code is another one
    const size_t count = scene.lines.size();
    cv::Mat others(int(count), 32, CV_8U);
    cv::RNG(6).fill(others, cv::RNG::UNIFORM, 0, 256);
    for (size_t i = 0; i < count; i++)
    {
        Segment& s = scene.image.segments[i];
        const Segment original = s;
        const Eigen::Vector2d d = s.direction(), aside(-3 * d.y(), 3 * d.x());
        s = {s.begin + aside, s.end + aside};
        scene.image.segments.push_back(original);
    }
    cv::vconcat(scene.image.codes, others, scene.image.codes);
    const std::vector<LineObservation> matches = scene.match(scene.described());
    ASSERT_EQ(count, matches.size());
    for (size_t i = 0; i < count; i++)
        EXPECT_EQ(scene.image.segments[i].begin, matches[i].segment.begin);
    EXPECT_NEAR(3 / 0.6745, deviation(matches, PINHOLE, POSE), 1e-6);

    // a code that is far from all is nobody's, and of two lines at one segment the one with the nearer code is taken
    std::vector<Line3> lines = scene.described();
    const cv::Mat inverted = ~scene.image.codes.rowRange(0, int(count));
    for (size_t i = 0; i < count; i += 2)
        lines[i].code = inverted.ptr(int(i));
    EXPECT_EQ(count / 2, scene.match(lines, 3.5).size());
    lines = scene.described();
    const std::vector<Line3> twice = scene.described();
    lines.insert(lines.end(), twice.begin(), twice.end());
    EXPECT_EQ(count, scene.match(lines).size());
}

TEST(LineFromDepth, a_line_on_a_slanted_wall_and_at_its_edge)
{
    // inverse depth is linear on a plane; the wall ends at column 300, and behind it is another, twice as far
    const auto inverse = [](double x, double y) { return (0.2 + 0.0003 * x + 0.0001 * y) / 1000; };
    cv::Mat depth(480, 640, CV_16U);
    for (int y = 0; y < depth.rows; y++)
        for (int x = 0; x < depth.cols; x++)
            depth.at<ushort>(y, x) = cv::saturate_cast<ushort>((x <= 300 ? 1 : 2) / inverse(x, y));
    const auto at = [&](const Eigen::Vector2d& p) {
        return POSE.toWorld(PINHOLE.ray(p) / inverse(p.x(), p.y()) / 1000);
    };
    const auto far = [&](const MapLine& line, const Segment& s) {
        const Eigen::Vector3d along = (at(s.end) - at(s.begin)).normalized();
        return std::max(
                along.cross(line.begin - at(s.begin)).norm(), along.cross(line.end - at(s.begin)).norm());
    };
    const Segment onWall = {{50, 60}, {200, 300}};
    std::optional<MapLine> line = lineFromDepth(onWall, CAMERA, POSE, depth);
    ASSERT_TRUE(line.has_value());
    EXPECT_LT(far(*line, onWall), 5e-3);
    EXPECT_LT((line->begin - at(onWall.begin)).norm(), 0.05);
    EXPECT_LT((line->end - at(onWall.end)).norm(), 0.05);

    const Segment edge = {{300.5, 300}, {300.5, 100}};
    line = lineFromDepth(edge, CAMERA, POSE, depth);
    ASSERT_TRUE(line.has_value());
    EXPECT_LT(far(*line, edge), 0.02) << "on the nearer wall";

    // a fifth of it is behind something
    depth(cv::Rect(40, 50, 160, 60)) = 900;
    line = lineFromDepth(onWall, CAMERA, POSE, depth);
    ASSERT_TRUE(line.has_value());
    EXPECT_LT(far(*line, onWall), 5e-3);
    EXPECT_GT((line->begin - at(onWall.begin)).norm(), 0.3);
    // half of it
    depth(cv::Rect(40, 50, 160, 130)) = 900;
    EXPECT_FALSE(lineFromDepth(onWall, CAMERA, POSE, depth));
    EXPECT_FALSE(lineFromDepth({{280, 400}, {320, 400}}, CAMERA, POSE, depth)) << "over the edge";
    EXPECT_FALSE(lineFromDepth(onWall, CAMERA, POSE, cv::Mat::zeros(480, 640, CV_16U))) << "unknown";
}

}  // namespace
