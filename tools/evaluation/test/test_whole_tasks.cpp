// SPDX-License-Identifier: Apache-2.0

#include <algorithm>
#include <cstdlib>

#include "../described_images.hpp"
#include "../experiments.hpp"
#include "../results.hpp"
#include "common/test/test_folder.hpp"
#include "opencv2/calib3d.hpp"
#include "opencv2/imgcodecs.hpp"
#include "opencv2/imgproc.hpp"

namespace {
using namespace iib_tools;

const cv::Size SIZE(480, 360);
const double FOCAL = 400;

struct Camera
{
    cv::Matx33d rotation;  // world to camera
    cv::Vec3d position;
    cv::Point2d project(const cv::Vec3d& point) const
    {
        const cv::Vec3d p = rotation * (point - position);
        return cv::Point2d(FOCAL * p[0] / p[2] + SIZE.width / 2, FOCAL * p[1] / p[2] + SIZE.height / 2);
    }
};

//! Small textures at points of space, the nearest in front; the same ones for every camera.
cv::Mat rendered(const Camera& camera, double brightness)
{
    cv::RNG rng(3);
    cv::Mat image(SIZE, CV_8U, cv::Scalar(100));
    for (int i = 0; i < 260; i++)
    {
        const double depth = 14 - 10. * i / 260;
        const cv::Vec3d point(rng.uniform(-0.6, 0.6) * depth, rng.uniform(-0.45, 0.45) * depth, depth);
        cv::Mat blocks(4, 4, CV_8U), texture;
        rng.fill(blocks, cv::RNG::UNIFORM, 10, 245);
        cv::resize(blocks, texture, cv::Size(28, 28), 0, 0, cv::INTER_NEAREST);
        const cv::Point corner(cv::Point(camera.project(point)) - cv::Point(14, 14));
        const cv::Rect seen = cv::Rect(corner, texture.size()) & cv::Rect(cv::Point(), SIZE);
        if (!seen.empty())
            texture(seen - corner).copyTo(image(seen));
    }
    image.convertTo(image, CV_8U, brightness, 20);
    return image;
}

class WholeTasksTest : public ::testing::Test
{
protected:
    void SetUp() CV_OVERRIDE
    {
        first.rotation = cv::Matx33d::eye();
        cv::Rodrigues(cv::Vec3d(0.02, 0.08, 0), second.rotation);
        second.position = cv::Vec3d(0.6, 0.1, 0);
        options.out = folder.path("results");
        options.roots = {folder.path("data")};
        options.experiments = {"whole_tasks"};
        options.detectors = {"AKAZE"};
        options.points = 600;
    }

    //! Least and largest error of the rows of a task that a descriptor has, by ratio and by mutual matches
    //! with a threshold of 2 pixels.
    std::pair<double, double> errors(const std::string& task, const std::string& descriptor) const
    {
        std::vector<double> found;
        size_t all = 0;
        for (const Fields& row : readRows(
                     options.out + "/whole_tasks.csv", {"task", "set", "sequence", "target", "detector",
                                                               "descriptor", "matching", "error", "inliers"}))
            if (row[0] == task && row[5] == descriptor)
            {
                all++;
                if (row[6] == "ratio at 2 px" || row[6] == "mutual at 2 px")
                    found.push_back(std::atof(row[7].c_str()));
            }
        EXPECT_EQ(9u, all);
        EXPECT_EQ(2u, found.size());
        if (found.empty())
            return {-1, -1};
        return {*std::min_element(found.begin(), found.end()), *std::max_element(found.begin(), found.end())};
    }

    TestFolder folder;
    Options options;
    Camera first, second;
};

TEST_F(WholeTasksTest, pose_of_two_views)
{
    folder.makeFolder("data/walk/images");
    folder.write("data/walk/cameras.txt", cv::format("1 PINHOLE 480 360 %g %g 240 180\n", FOCAL, FOCAL));
    // The inverse rotation, as a quaternion.
    const cv::Vec3d half = cv::Vec3d(-0.02, -0.08, 0) * 0.5;
    const double w = std::cos(cv::norm(half)), s = std::sin(cv::norm(half)) / cv::norm(half);
    folder.write("data/walk/poses.txt", "a 0 0 0 0 0 0 1\n" + cv::format("b 0.6 0.1 0 %.9f %.9f %.9f %.9f\n",
                                                                      half[0] * s, half[1] * s, 0., w));
    cv::imwrite(folder.path("data/walk/images/a.png"), rendered(first, 0.9));
    cv::imwrite(folder.path("data/walk/images/b.png"), rendered(second, 0.6));
    EXPECT_EQ(0, evaluate(options));
    EXPECT_LT(errors("pose", "IIB").first, 4);
    EXPECT_LT(errors("pose", "IIB VIEWPOINT").second, 4);

    // A wrong truth is a large error.
    folder.write("data/walk/poses.txt", "a 0 0 0 0 0 0 1\nb 0 0.6 0 0 0.3826834 0 0.9238795\n");
    options.out = folder.path("wrong");
    EXPECT_EQ(0, evaluate(options));
    EXPECT_GT(errors("pose", "IIB").first, 30);
}

TEST_F(WholeTasksTest, homography_and_epipolar_geometry)
{
    const cv::Mat image = rendered(first, 0.9), shift = (cv::Mat_<double>(2, 3) << 1.02, 0, 7, 0.01, 1, -5);
    cv::Mat moved;
    cv::warpAffine(image, moved, shift, SIZE);
    folder.makeFolder("data/set/flat");
    cv::imwrite(folder.path("data/set/flat/1.png"), image);
    cv::imwrite(folder.path("data/set/flat/2.png"), moved);
    folder.write("data/set/flat/H_1_2", "1.02 0 7 0.01 1 -5 0 0 1");
    folder.makeFolder("data/set/deep");
    cv::imwrite(folder.path("data/set/deep/1.png"), image);
    cv::imwrite(folder.path("data/set/deep/2.png"), rendered(second, 0.6));
    std::string known;
    for (const cv::Vec3d& p :
            {cv::Vec3d(-2, 1, 8), cv::Vec3d(1, -1, 5), cv::Vec3d(2, 2, 11), cv::Vec3d(0, 1, 6)})
    {
        const cv::Point2d a = first.project(p), b = second.project(p);
        known += cv::format("%.3f %.3f %.3f %.3f\n", a.x, a.y, b.x, b.y);
    }
    folder.write("data/set/deep/corrs.txt", known);
    EXPECT_EQ(0, evaluate(options));
    EXPECT_LT(errors("homography", "IIB").second, 2);
    EXPECT_LT(errors("homography", "AKAZE").second, 2);
    EXPECT_LT(errors("epipolar", "IIB").second, 3);

    // Other experiments leave out pairs without a homography.
    options.experiments = {"fixed_points"};
    evaluate(options);
    for (const Fields& row : readRows(options.out + "/fixed_points.csv", fixedPointsColumns()))
        EXPECT_EQ("flat", row[1]);
}

TEST(DescribedImages, the_last_ones_are_kept)
{
    int detections = 0;
    Detector detector;
    detector.name = "counted";
    detector.scaleFactor = 1;
    detector.detect = [&](const cv::Mat&, const ImagePair&, const std::string&) {
        detections++;
        return Detection{{cv::KeyPoint(50, 50, 20)}, cv::Mat(), 0};
    };
    const cv::Mat image(100, 100, CV_8U, cv::Scalar(90));
    DescribedImages described(2);
    const auto get = [&](const char* file) { return described.get(detector, image, ImagePair(), file); };
    const DescribedImages::Result first = get("a");
    EXPECT_EQ("IIB", first->back().name);
    EXPECT_EQ(first, get("a"));
    get("b");
    EXPECT_EQ(first, get("a"));
    EXPECT_EQ(2, detections);
    get("c");  // a leaves
    get("b");
    EXPECT_EQ(3, detections);
    get("a");
    EXPECT_EQ(4, detections);
    detector.name = "other";
    get("a");
    EXPECT_EQ(5, detections);
}

TEST(DescribedImages, own_descriptors_of_one_image_alone_are_refused)
{
    Detector detector;
    detector.name = "network";
    detector.descriptor = "network";
    detector.scaleFactor = 1;
    detector.detect = [](const cv::Mat&, const ImagePair&, const std::string& file) {
        return Detection{
                {cv::KeyPoint(50, 50, 20)}, cv::Mat::zeros(1, 8, CV_8U), file == "a" ? cv::NORM_HAMMING : 0};
    };
    const cv::Mat image(100, 100, CV_8U, cv::Scalar(90));
    DescribedImages described;
    ImagePair pair;
    pair.referenceFile = "a";
    pair.targetFile = "b";
    EXPECT_THROW(described.both(detector, image, image, pair), cv::Exception);
    pair.targetFile = "a";
    EXPECT_EQ("network", described.both(detector, image, image, pair).second->front().name);
}

TEST_F(WholeTasksTest, too_few_matches_are_a_failure)
{
    folder.makeFolder("data/set/empty");
    for (const char* name : {"1.png", "2.png"})
        cv::imwrite(folder.path(std::string("data/set/empty/") + name), cv::Mat(SIZE, CV_8U, cv::Scalar(90)));
    EXPECT_EQ(0, evaluate(options));
    EXPECT_EQ(HUGE_VAL, errors("homography", "IIB").first);
}

}  // namespace
