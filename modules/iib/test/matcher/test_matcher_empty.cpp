// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "../support/matcher_oracle.hpp"

namespace opencv_test {
namespace {

// Calls without train descriptors or queries: DescriptorMatcher returns before it looks at anything.
const Mat SOME = randomDescriptors(1, 5, 42), NONE;

Ptr<HierarchicalMatcher> createMatcher() { return HierarchicalMatcher::create({2, 8, 32}); }

//! Results of an earlier call, which must not survive.
const std::vector<DMatch> OLD(7);
const Matches OLD_ROWS(7, std::vector<DMatch>(2));

TEST(IIB_MatcherEmpty, without_train_descriptors_rows_are_empty)
{
    const Ptr<HierarchicalMatcher> matcher = createMatcher();
    std::vector<DMatch> best;
    matcher->match(SOME, best = OLD);
    EXPECT_TRUE(best.empty());
    matcher->match(SOME, NONE, best = OLD);
    EXPECT_TRUE(best.empty());
    Matches rows;
    matcher->knnMatch(SOME, rows = OLD_ROWS, 2);
    expectEqual(Matches(5), rows);
    matcher->radiusMatch(SOME, rows = OLD_ROWS, 10);
    expectEqual(Matches(5), rows);
    matcher->radiusMatch(SOME, Mat(0, 42, CV_8U), rows = OLD_ROWS, 10);
    expectEqual(Matches(5), rows);
    matcher->knnMatch(SOME, rows = OLD_ROWS, 2, noArray(), true);
    EXPECT_TRUE(rows.empty());
    Mat indices, distances;
    matcher->knnMatchArrays(SOME, NONE, indices, distances, 2);
    EXPECT_EQ(0, cvtest::norm(indices, Mat(5, 2, CV_32S, Scalar(-1)), NORM_INF));
}

TEST(IIB_MatcherEmpty, without_queries_nothing_is_left)
{
    const Ptr<HierarchicalMatcher> matcher = createMatcher();
    for (bool trained : {false, true})
    {
        if (trained)
            matcher->add(SOME);
        std::vector<DMatch> best = OLD;
        matcher->match(NONE, best);
        EXPECT_TRUE(best.empty());
        Matches rows = OLD_ROWS;
        matcher->knnMatch(NONE, rows, 2);
        EXPECT_TRUE(rows.empty());
        matcher->knnMatch(NONE, SOME, rows = OLD_ROWS, 2);
        EXPECT_TRUE(rows.empty());
        matcher->radiusMatch(NONE, SOME, rows = OLD_ROWS, 3);
        EXPECT_TRUE(rows.empty());
    }
}

TEST(IIB_MatcherEmpty, arguments_are_checked_all_the_same)
{
    const Ptr<HierarchicalMatcher> matcher = createMatcher();
    Matches rows;
    const Mat wrong(3, 41, CV_8U, Scalar(0)), floats(3, 42, CV_32F, Scalar(0));
    for (const Mat& queries : {SOME, NONE})
    {
        EXPECT_THROW(matcher->knnMatch(queries, rows, 0), cv::Exception);
        EXPECT_THROW(matcher->knnMatch(queries, rows, -1), cv::Exception);
        EXPECT_THROW(matcher->knnMatch(queries, SOME, rows, 0), cv::Exception);
        EXPECT_THROW(matcher->radiusMatch(queries, rows, 0.f), cv::Exception);
        EXPECT_THROW(
                matcher->radiusMatch(queries, rows, std::numeric_limits<float>::quiet_NaN()), cv::Exception);
        EXPECT_THROW(matcher->knnMatch(queries, rows, 1, std::vector<Mat>(1, Mat(5, 5, CV_8U, Scalar(1)))),
                cv::Exception);
        EXPECT_THROW(matcher->knnMatch(queries, wrong, rows, 1), cv::Exception);
    }
    EXPECT_THROW(matcher->knnMatch(wrong, rows, 1), cv::Exception);
    EXPECT_THROW(matcher->knnMatch(floats, rows, 1), cv::Exception);
    EXPECT_THROW(matcher->radiusMatch(wrong, rows, 3.f), cv::Exception);
}

TEST(IIB_MatcherEmpty, masks_of_no_rows_fit)
{
    const Ptr<HierarchicalMatcher> matcher = createMatcher();
    matcher->add(SOME);
    Matches rows = OLD_ROWS;
    matcher->knnMatch(Mat(0, 42, CV_8U), rows, 2, std::vector<Mat>(1, Mat(0, 5, CV_8U)));
    EXPECT_TRUE(rows.empty());
}

}  // namespace
}  // namespace opencv_test
