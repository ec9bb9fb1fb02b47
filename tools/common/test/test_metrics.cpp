// SPDX-License-Identifier: Apache-2.0

#include <cmath>

#include "../metrics.hpp"
#include "opencv2/ts.hpp"

namespace {
using namespace iib_tools;

cv::KeyPoint point(float x, float y, float size = 10) { return cv::KeyPoint(x, y, size); }

TEST(Metrics, precision_and_recall)
{
    const Counts counts = {3, 4, 12};
    EXPECT_DOUBLE_EQ(0.75, precision(counts));
    EXPECT_DOUBLE_EQ(0.25, recall(counts));
    const Counts none = {0, 0, 0};
    EXPECT_EQ(0, precision(none));
    EXPECT_EQ(0, recall(none));
}

TEST(Metrics, projection_and_its_scale)
{
    const cv::Matx33d H(2, 0.1, 5, -0.2, 1.5, 7, 1e-3, 2e-3, 1);
    const cv::Point2d p(30, 40);
    const cv::Point2d q = project(H, p);
    EXPECT_NEAR((60 + 4 + 5) / 1.11, q.x, 1e-12);
    EXPECT_NEAR((-6 + 60 + 7) / 1.11, q.y, 1e-12);

    const double h = 1e-5;  // side of a small square, whose projected area gives the scale
    const cv::Point2d dx = (project(H, p + cv::Point2d(h, 0)) - q) / h;
    const cv::Point2d dy = (project(H, p + cv::Point2d(0, h)) - q) / h;
    EXPECT_NEAR(std::sqrt(std::abs(dx.cross(dy))), localScale(H, p), 1e-4);
    EXPECT_TRUE(std::isinf(project(cv::Matx33d(1, 0, 0, 0, 1, 0, 1, 0, 0), cv::Point2d(0, 1)).x));
}

TEST(Metrics, correct_within_the_tolerance_of_the_projection)
{
    const cv::Matx33d shift(1, 0, 10, 0, 1, 0, 0, 0, 1);
    const std::vector<cv::KeyPoint> reference = {point(0, 0), point(50, 50)};
    const std::vector<cv::KeyPoint> target = {point(10, 3), point(60, 53.1f)};
    const std::vector<cv::DMatch> matches = {cv::DMatch(0, 0, 1), cv::DMatch(1, 1, 1), cv::DMatch(0, 1, 1)};
    EXPECT_EQ(
            std::vector<bool>({true, false, false}), correctByLocation(matches, reference, target, shift, 3));
}

TEST(Metrics, regions_correspond_by_location_and_size)
{
    const cv::Matx33d twice(2, 0, 0, 0, 2, 0, 0, 0, 1);
    EXPECT_TRUE(correspond(point(10, 10, 8), point(20, 22, 16), twice, 3));
    EXPECT_FALSE(correspond(point(10, 10, 8), point(20, 24, 16), twice, 3));
    // A ratio of areas of 2 is an overlap error of 50 %: 16 / sqrt(2) = 11.3.
    EXPECT_TRUE(correspond(point(10, 10, 8), point(20, 20, 11.4f), twice, 3));
    EXPECT_FALSE(correspond(point(10, 10, 8), point(20, 20, 11.2f), twice, 3));
    EXPECT_FALSE(correspond(point(10, 10, 8), point(20, 20, 22.7f), twice, 3));
}

TEST(Metrics, correspondences_are_one_to_one_and_as_many_as_can_be)
{
    const cv::Matx33d eye = cv::Matx33d::eye();
    // A greedy choice of the nearest for the first point would leave none for the second.
    EXPECT_EQ(2, countCorrespondences({point(2, 0), point(5, 0)}, {point(3, 0), point(0, 0)}, eye, 3));
    EXPECT_EQ(1, countCorrespondences({point(0, 0), point(1, 0), point(2, 0)}, {point(1, 0)}, eye, 3));
    EXPECT_EQ(0, countCorrespondences({point(0, 0)}, {point(9, 0)}, eye, 3));
    EXPECT_EQ(0, countCorrespondences({}, {}, eye, 3));
}

}  // namespace
