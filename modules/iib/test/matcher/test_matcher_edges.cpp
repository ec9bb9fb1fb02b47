// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "../support/matcher_oracle.hpp"
#include "../support/test_errors.hpp"
#include "../../src/matcher/search.hpp"

#include <numeric>

#ifdef __linux__
#include <fstream>
#include <sys/resource.h>
#include <unistd.h>
#endif

namespace opencv_test { namespace {

// Edge cases where BFMatcher fails or behaves unexpectedly, and OpenCV's own matcher tests with NORM_HAMMING.

const int BYTES = 42;
const std::vector<int> LEVELS = {2, 8, 32};

Ptr<HierarchicalMatcher> matcherOf(const std::vector<Mat>& images)
{
    const Ptr<HierarchicalMatcher> matcher = HierarchicalMatcher::create(LEVELS);
    matcher->add(images);
    return matcher;
}

//! A code of some bytes whose first bits are set, for each number of bits.
Mat codesOfBits(const std::vector<int>& counts, int bytes)
{
    Mat codes((int)counts.size(), bytes, CV_8U, Scalar(0));
    for (int i = 0; i < codes.rows; i++)
        for (int bit = 0; bit < counts[i]; bit++)
            codes.at<uchar>(i, bit / 8) |= (uchar)(1 << bit % 8);
    return codes;
}

// Descriptor i has its first i bits set: the distance between two is the difference of their numbers.
Mat ladder(int first, int rows, int bytes = BYTES)
{
    std::vector<int> counts(rows);
    std::iota(counts.begin(), counts.end(), first);
    return codesOfBits(counts, bytes);
}

TEST(IIB_KnnTable, what_memory_cannot_hold_is_an_error_that_names_k)
{
    expectError(Error::StsNoMem, format("k is %d", INT_MAX), [] { KnnTable(INT_MAX, INT_MAX); });
    expectError(
            Error::StsNoMem, format("k is %d", INT_MAX), [] { forNeighbours<int64>(INT_MAX, INT_MAX, -1); });
}

TEST(IIB_MatcherEdges, more_neighbours_asked_for_than_there_are)
{
    Matches matches;
    matcherOf({ladder(0, 3)})->knnMatch(ladder(1, 2), matches, INT_MAX);
    ASSERT_EQ(2u, matches.size());
    EXPECT_EQ(3u, matches[0].size());
}

// too wide for keys of 31 bits
TEST(IIB_MatcherEdges, very_wide_codes)
{
    MatcherOracle oracle;
    oracle.levelSizes = {70000};
    oracle.images.push_back(randomDescriptors(1, 20, 70000));
    const Mat queries = randomDescriptors(2, 5, 70000);
    for (bool crossCheck : {false, true})
    {
        oracle.crossCheck = crossCheck;
        expectKnnAsOracle(*oracle.matcher(), oracle, queries, 1);
    }
}

TEST(IIB_MatcherEdges, empty_image_among_several_is_skipped)
{
    const Ptr<HierarchicalMatcher> matcher =
            matcherOf({Mat(), ladder(10, 1), Mat(0, BYTES, CV_8U), ladder(0, 1), Mat()});
    std::vector<DMatch> matches;
    matcher->match(ladder(1, 1), matches);
    ASSERT_EQ(1u, matches.size());
    EXPECT_EQ(3, matches[0].imgIdx);
    std::vector<Mat> masks(5);
    masks[0] = Mat(1, 3, CV_8U, Scalar(1));  // a mask for an image without rows cannot fit
    EXPECT_THROW(matcher->match(ladder(1, 1), matches, masks), cv::Exception);
    masks[0] = Mat();
    masks[3] = Mat(1, 1, CV_8U, Scalar(0));
    matcher->match(ladder(1, 1), matches, masks);
    ASSERT_EQ(1u, matches.size());
    EXPECT_EQ(1, matches[0].imgIdx);
}

// Also if the float is above the decimal number.
TEST(IIB_MatcherEdges, ties_at_any_hundredth_are_refused)
{
    const Mat zero = codesOfBits({0}, 13);
    for (int hundredth = 1; hundredth < 100; hundredth++)
    {
        const Ptr<HierarchicalMatcher> matcher = HierarchicalMatcher::create({13});
        matcher->setMaxRatio(hundredth / 100.f);
        std::vector<DMatch> tie, nearer;
        matcher->match(zero, codesOfBits({hundredth, 100}, 13), tie);
        matcher->match(zero, codesOfBits({hundredth - 1, 100}, 13), nearer);
        EXPECT_EQ(0u, tie.size()) << hundredth;
        EXPECT_EQ(1u, nearer.size()) << hundredth;
    }
}

TEST(IIB_MatcherEdges, ties_at_any_hundredth_are_within_the_threshold)
{
    const Mat codes = ladder(0, 161, 21);
    for (int hundredth = 0; hundredth <= 100; hundredth++)
    {
        Matches matches;
        HierarchicalMatcher::create({20, 1}, HierarchicalMatcher::THRESHOLD, hundredth / 100.f)
                ->knnMatch(codes.row(0), codes, matches, 200);
        EXPECT_EQ((size_t)(hundredth * 160 / 100) + 1, matches[0].size()) << hundredth;
    }
}

TEST(IIB_MatcherEdges, arrays_hold_what_knnMatch_finds)
{
    const Ptr<HierarchicalMatcher> matcher = matcherOf({ladder(0, 3), Mat(), ladder(3, 5)});
    const Mat queries = ladder(2, 4);
    const int k = 10;  // two more than there are
    Matches matches;
    matcher->knnMatch(queries, matches, k);
    Mat_<int> indices, distances, images;
    matcher->knnMatchArrays(queries, indices, distances, k, noArray(), images);
    for (const Mat& m : {indices, distances, images})
        ASSERT_EQ(Size(k, queries.rows), m.size());
    for (int q = 0; q < queries.rows; q++)
        for (int i = 0; i < k; i++)
        {
            const DMatch m = i < 8 ? matches[q][i] : DMatch(q, -1, -1, -1);
            EXPECT_EQ(m.trainIdx, indices(q, i));
            EXPECT_EQ(m.imgIdx, images(q, i));
            EXPECT_EQ((int)m.distance, distances(q, i));
        }
}

// More rows than BFMatcher's 262,144 an image, more images than its 8,191.
TEST(IIB_MatcherEdges, no_limit_on_rows_and_images)
{
    const int rows = 300001;
    Mat many(rows, 4, CV_8U);
    for (int i = 0; i < rows; i++)
        for (int byte = 0; byte < 4; byte++)
            many.at<uchar>(i, byte) = (uchar)(i >> 8 * byte);
    const Ptr<HierarchicalMatcher> matcher = HierarchicalMatcher::create(std::vector<int>(1, 4));
    matcher->add(many);
    std::vector<DMatch> matches;
    matcher->match(many.rowRange(rows - 3, rows), matches);
    ASSERT_EQ(3u, matches.size());
    EXPECT_EQ(rows - 1, matches[2].trainIdx);
    matcher->clear();
    for (int i = 0; i < 9000; i++)
        matcher->add(many.row(i));
    matcher->match(many.row(8999), matches);
    EXPECT_EQ(8999, matches[0].imgIdx);
    EXPECT_EQ(0, matches[0].trainIdx);
}

// opencv#11855
TEST(IIB_MatcherEdges, cross_check_with_compact_result)
{
    const Mat trains = Mat_<uchar>({2, 3}, {1, 1, 0, 1, 1, 1}),
              queries = Mat_<uchar>({2, 3}, {1, 1, 1, 0, 0, 0});
    const Ptr<HierarchicalMatcher> matcher =
            HierarchicalMatcher::create(std::vector<int>(1, 3), HierarchicalMatcher::EXACT, 0.35f, true);
    Matches matches;
    matcher->knnMatch(queries, trains, matches, 1, noArray(), true);
    ASSERT_EQ(1u, matches.size());
    EXPECT_EQ(1, matches[0][0].trainIdx);
    matcher->knnMatch(trains, queries, matches, 1);
    EXPECT_EQ(2u, matches.size());
    EXPECT_TRUE(matches[0].empty());
}

// Found by fuzzing: a train descriptor had too few neighbours.
TEST(IIB_MatcherEdges, cross_check_with_more_neighbours_than_trains)
{
    MatcherOracle oracle;
    oracle.levelSizes = LEVELS;
    oracle.images = {ladder(7, 3)};
    oracle.crossCheck = true;
    expectKnnAsOracle(*oracle.matcher(), oracle, ladder(0, 20), 16);
}

TEST(IIB_MatcherEdges, umat_queries_trains_and_masks)
{
    const Mat train = ladder(0, 20), queries = ladder(3, 4);
    const Mat mask = randomMask(1, 4, 20, 0.5);
    Matches expected, actual;
    const Ptr<HierarchicalMatcher> matcher = HierarchicalMatcher::create(LEVELS);
    matcher->knnMatch(queries, train, expected, 2, mask);
    UMat deviceQueries, deviceTrain, deviceMask;
    queries.copyTo(deviceQueries);
    train.copyTo(deviceTrain);
    mask.copyTo(deviceMask);
    matcher->knnMatch(deviceQueries, deviceTrain, actual, 2, deviceMask);
    expectEqual(expected, actual);
    matcher->add(std::vector<UMat>(1, deviceTrain));
    deviceTrain.release();
    matcher->knnMatch(queries, actual, 2, std::vector<Mat>(1, mask));
    expectEqual(expected, actual);
}

TEST(IIB_MatcherEdges, bad_input_throws)
{
    std::vector<DMatch> matches;
    const Ptr<HierarchicalMatcher> matcher = matcherOf({ladder(0, 5)});
    EXPECT_THROW(matcher->add(Mat(3, BYTES + 1, CV_8U, Scalar(0))), cv::Exception);
    EXPECT_EQ(1u, matcher->getTrainDescriptors().size());
    for (Size size : {Size(4, 2), Size(5, 1), Size(5, 3)})
        EXPECT_THROW(matcher->match(ladder(0, 2), matches, std::vector<Mat>(1, Mat(size, CV_8U, Scalar(1)))),
                cv::Exception);
    EXPECT_THROW(matcher->match(ladder(0, 2), matches, std::vector<Mat>(1, Mat(2, 5, CV_32S, Scalar(1)))),
            cv::Exception);
    EXPECT_THROW(matcher->match(ladder(0, 2), matches, std::vector<Mat>(2)), cv::Exception);
    EXPECT_THROW(matcher->setMode(3), cv::Exception);
    EXPECT_THROW(matcher->setThresholds({0.1f, 0.2f, 0.3f}), cv::Exception);
    EXPECT_THROW(matcher->setThresholds({1.5f}), cv::Exception);
    EXPECT_THROW(matcher->setMaxRatio(0), cv::Exception);
    EXPECT_THROW(HierarchicalMatcher::create(std::vector<int>()), cv::Exception);
    EXPECT_THROW(HierarchicalMatcher::create({8, 0}), cv::Exception);
    EXPECT_THROW(HierarchicalMatcher::create({32}, HierarchicalMatcher::THRESHOLD, -1.f), cv::Exception);
}

#if defined __linux__ && !defined __SANITIZE_ADDRESS__ && !defined __SANITIZE_THREAD__
//! Limits the process to this many further bytes.
struct LittleMemory
{
    rlimit before;
    explicit LittleMemory(rlim_t bytes)
    {
        size_t pages = 0;
        std::ifstream("/proc/self/statm") >> pages;
        getrlimit(RLIMIT_AS, &before);
        rlimit limit = before;
        limit.rlim_cur = pages * sysconf(_SC_PAGESIZE) + bytes;
        setrlimit(RLIMIT_AS, &limit);
    }
    ~LittleMemory() { setrlimit(RLIMIT_AS, &before); }
};

// Without stages, codes are not unpacked: 128 MB here.
TEST(IIB_MatcherEdges, long_codes_take_no_second_copy)
{
    const int bytes = 1 << 16, rows = 2048;
    const Ptr<HierarchicalMatcher> matcher = HierarchicalMatcher::create(std::vector<int>(1, bytes));
    matcher->add(randomDescriptors(1, rows, bytes));
    const Mat query = randomDescriptors(2, 1, bytes);
    Matches found;
    matcher->knnMatch(query, found, 3);  // the threads, if there were none
    const LittleMemory little(64 << 20);
    EXPECT_NO_THROW(matcher->knnMatch(query, found, 2));
}
#endif

// Calls without queries or train descriptors: of a matcher without images, and of one with an image that has no rows.
const Mat SOME = randomDescriptors(1, 5, 42), NONE;

//! Results of an earlier call.
const std::vector<DMatch> OLD(7);
const Matches OLD_ROWS(7, std::vector<DMatch>(2));

TEST(IIB_MatcherEmpty, without_train_rows_the_rows_are_empty)
{
    const Ptr<HierarchicalMatcher> matcher = matcherOf({NONE});
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

// As BFMatcher, whose knnMatch may leave its results unchanged.
TEST(IIB_MatcherEmpty, without_queries_or_images_as_every_matcher)
{
    const Ptr<DescriptorMatcher> matchers[] = {
            HierarchicalMatcher::create(LEVELS), BFMatcher::create(NORM_HAMMING)};
    for (const Ptr<DescriptorMatcher>& matcher : matchers)
        for (bool trained : {false, true})
        {
            if (trained)
                matcher->add(SOME);
            const Mat queries = trained ? NONE : SOME;
            std::vector<DMatch> best = OLD;
            matcher->match(queries, best);
            EXPECT_TRUE(best.empty());
            Matches rows;
            matcher->knnMatch(queries, rows = OLD_ROWS, 2);
            EXPECT_EQ(OLD_ROWS.size(), rows.size());
            matcher->radiusMatch(queries, rows = OLD_ROWS, 3);
            EXPECT_TRUE(rows.empty());
            matcher->match(NONE, SOME, best = OLD);
            EXPECT_TRUE(best.empty());
            matcher->radiusMatch(NONE, SOME, rows = OLD_ROWS, 3);
            EXPECT_TRUE(rows.empty());
        }
}

// A DescriptorMatcher has one behaviour, whatever its static type.
TEST(IIB_MatcherEmpty, arguments_are_checked_the_same_through_the_base)
{
    const Ptr<HierarchicalMatcher> matcher = matcherOf({NONE});
    DescriptorMatcher& base = *matcher;
    Matches rows;
    const Mat wrong(3, 41, CV_8U, Scalar(0)), floats(3, 42, CV_32F, Scalar(0));
    const std::vector<Mat> mask(1, Mat(5, 5, CV_8U, Scalar(1)));
    const float notANumber = std::numeric_limits<float>::quiet_NaN();
    const std::function<void()> calls[] = {[&] { matcher->knnMatch(SOME, rows, 0); },
            [&] { base.knnMatch(SOME, rows, 0); }, [&] { matcher->knnMatch(SOME, SOME, rows, -1); },
            [&] { matcher->radiusMatch(SOME, rows, 0.f); }, [&] { base.radiusMatch(SOME, rows, notANumber); },
            [&] { matcher->knnMatch(SOME, rows, 1, mask); }, [&] { base.knnMatch(SOME, rows, 1, mask); },
            [&] { matcher->knnMatch(SOME, wrong, rows, 1); }, [&] { matcher->knnMatch(wrong, rows, 1); },
            [&] { base.knnMatch(floats, rows, 1); }, [&] { base.radiusMatch(wrong, rows, 3.f); }};
    for (const std::function<void()>& call : calls)
        EXPECT_THROW(call(), cv::Exception);
    Mat indices, distances;
    for (const Mat& queries : {SOME, NONE})
    {
        EXPECT_THROW(matcher->knnMatchArrays(queries, indices, distances, 0), cv::Exception);
        EXPECT_THROW(matcher->knnMatchArrays(queries, wrong, indices, distances), cv::Exception);
    }
}

TEST(IIB_MatcherEmpty, masks_of_no_rows_fit)
{
    const Ptr<HierarchicalMatcher> matcher = HierarchicalMatcher::create(LEVELS);
    matcher->add(SOME);
    Mat indices, distances;
    matcher->knnMatchArrays(Mat(0, 42, CV_8U), indices, distances, 2, std::vector<Mat>(1, Mat(0, 5, CV_8U)));
    EXPECT_EQ(0, indices.rows);
}

// A thousand million columns of -1 would take all memory.
TEST(IIB_MatcherEdges, more_neighbours_than_there_can_be_are_refused)
{
    const Ptr<HierarchicalMatcher> matcher = HierarchicalMatcher::create();
    Mat indices, distances;
    expectError(Error::StsOutOfRange, "k is 1000000000, but there are 3 descriptors",
            [&] { matcher->knnMatchArrays(ladder(0, 2), ladder(0, 3), indices, distances, 1000000000); });
    matcher->knnMatchArrays(ladder(0, 2), ladder(0, 3), indices, distances, 100);
    EXPECT_EQ(Size(100, 2), indices.size());
}

// Columns of wider matrices, which may change later, and results as numbers and rows of any kind.
TEST(IIB_MatcherEdges, takes_views_and_gives_vectors)
{
    Mat wide(40, 100, CV_8U);
    randu(wide, 0, 256);
    const Mat view = wide.colRange(20, 62), whole = view.clone();
    const Ptr<HierarchicalMatcher> matcher = HierarchicalMatcher::createRecommended();
    Mat indices, distances, expectedIndices, expectedDistances;
    matcher->knnMatchArrays(whole.rowRange(0, 9), whole, expectedIndices, expectedDistances, 2);
    matcher->knnMatchArrays(view.rowRange(0, 9), view, indices, distances, 2);
    EXPECT_EQ(0, cvtest::norm(expectedIndices, indices, NORM_INF));
    std::vector<Vec2i> pairs;
    std::vector<Vec2d> bits;
    matcher->knnMatchArrays(view.rowRange(0, 9), view, pairs, bits, 2);
    EXPECT_EQ(0, cvtest::norm(expectedIndices.reshape(2), Mat(pairs).reshape(2, 9), NORM_INF));
    EXPECT_EQ(expectedDistances.at<int>(8, 0), bits[8][0]);
    std::vector<int> nearest, distance;
    matcher->add(std::vector<Mat>(1, view));
    wide.setTo(0);
    matcher->knnMatchArrays(whole, nearest, distance);
    EXPECT_EQ(40u, nearest.size());
    EXPECT_EQ(39, nearest[39]);
    EXPECT_EQ(std::vector<int>(40, 0), distance);
}

}}  // namespace opencv_test
