// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "../support/matcher_oracle.hpp"
#include "../support/textures.hpp"
#include "../../src/matcher/kernels/hamming.hpp"

#include <thread>

namespace opencv_test { namespace {

const std::vector<int> LEVELS = {2, 8, 32};

typedef testing::TestWithParam<int> IIB_Matcher_Threads;  // mode

TEST_P(IIB_Matcher_Threads, same_result_for_every_number)
{
    typedef std::pair<Matches, double> Result;  // and the cost
    const Mat train = randomDescriptors(1, 1300, 42), queries = randomDescriptors(2, 1100, 42);
    for (bool crossCheck : {false, true})
        forEveryNumberOfThreads(
                [&] {
                    const Ptr<HierarchicalMatcher> matcher =
                            HierarchicalMatcher::create(LEVELS, GetParam(), 0.35f, crossCheck);
                    Matches matches, within;
                    matcher->knnMatch(queries, train, matches, 2);
                    matcher->radiusMatch(queries, train, within, 30);
                    matches.insert(matches.end(), within.begin(), within.end());
                    return Result(matches, matcher->matchCost());
                },
                [](const Result& expected, const Result& actual) {
                    expectEqual(expected.first, actual.first);
                    EXPECT_EQ(expected.second, actual.second);
                });
}

// Threads call different functions; each result is that of a single thread.
TEST_P(IIB_Matcher_Threads, one_object_serves_many)
{
    const Ptr<HierarchicalMatcher> matcher = HierarchicalMatcher::create(LEVELS, GetParam(), 0.35f, true);
    matcher->add(std::vector<Mat>{randomDescriptors(1, 500, 42), randomDescriptors(3, 300, 42)});
    const Mat queries = randomDescriptors(2, 300, 42);
    const std::vector<Mat> masks = {randomMask(4, 300, 500, 0.5), Mat()};
    const auto ask = [&](size_t thread) {
        Matches matches;
        switch (thread % 4)
        {
        case 0: matcher->knnMatch(queries, matches, 2); break;
        case 1: matcher->knnMatch(queries, matches, 1, masks, true); break;
        case 2: matcher->radiusMatch(queries, matches, 40); break;
        default:
            Mat indices, distances;
            matcher->knnMatchArrays(queries, indices, distances, 2);
            for (int q = 0; q < indices.rows; q++)
                matches.push_back(
                        std::vector<DMatch>(1, DMatch(q, indices.at<int>(q), (float)distances.at<int>(q))));
        }
        return matches;
    };
    std::vector<Matches> results(8);
    std::vector<std::thread> threads;
    for (size_t i = 0; i < results.size(); i++)
        threads.push_back(std::thread([&, i] {
            for (int repeat = 0; repeat < 3; repeat++)
            {
                results[i] = ask(i);
                matcher->matchCost();
            }
        }));
    for (size_t i = 0; i < threads.size(); i++)
        threads[i].join();
    for (size_t i = 0; i < results.size(); i++)
        expectEqual(ask(i), results[i]);
}

INSTANTIATE_TEST_CASE_P(/**/, IIB_Matcher_Threads,
        testing::Values((int)HierarchicalMatcher::EXACT, (int)HierarchicalMatcher::THRESHOLD,
                (int)HierarchicalMatcher::ADAPTIVE));

//! Restores cv::useOptimized() at the end of a test.
struct OptimizationToggle
{
    const bool before;
    OptimizationToggle() : before(useOptimized()) {}
    ~OptimizationToggle() { setUseOptimized(before); }
};

// Codes are packed for the instruction set when they are added; a later change must not matter.
typedef testing::TestWithParam<std::tuple<int, bool, bool>>
        IIB_Matcher_Toggle;  // mode, cross-check, optimized at add

TEST_P(IIB_Matcher_Toggle, between_add_and_match)
{
    const OptimizationToggle restore;
    const int mode = std::get<0>(GetParam());
    const bool first = std::get<2>(GetParam());
    MatcherOracle oracle;
    oracle.levelSizes = {2, 8, 32};
    oracle.images = {randomDescriptors(1, 100, 42), randomDescriptors(2, 37, 42)};
    oracle.crossCheck = std::get<1>(GetParam());
    if (mode == HierarchicalMatcher::THRESHOLD)
        oracle.thresholds.assign(2, 0.35f);
    const Mat queries = randomDescriptors(3, 50, 42);
    const Matches nearby = oracle.radius(queries, 40);
    if (mode == HierarchicalMatcher::ADAPTIVE)  // not in radiusMatch
        oracle.adaptiveBlock = cv::iib::PruningPolicy::CODE_BLOCKS_OF_LIMITS * 16;
    const Matches nearest = oracle.knn(queries, 1), three = oracle.knn(queries, 3);

    setUseOptimized(first);
    const Ptr<HierarchicalMatcher> matcher =
            HierarchicalMatcher::create(oracle.levelSizes, mode, 0.35f, oracle.crossCheck);
    matcher->add(oracle.images[0]);
    setUseOptimized(!first);
    matcher->add(oracle.images[1]);
    const auto expectAll = [&](DescriptorMatcher& m) {
        Matches actual;
        m.knnMatch(queries, actual, 1);  // EXACT has a scan of its own for this
        expectEqual(nearest, actual);
        m.knnMatch(queries, actual, 3);
        expectEqual(three, actual);
        m.radiusMatch(queries, actual, 40);
        expectEqual(nearby, actual);
    };
    expectAll(*matcher);
    const Ptr<DescriptorMatcher> copy = matcher->clone();
    setUseOptimized(first);
    expectAll(*copy);
    expectAll(*matcher);
    EXPECT_EQ(0, cvtest::norm(oracle.images[1], matcher->getTrainDescriptors()[1], NORM_INF));
}

INSTANTIATE_TEST_CASE_P(/**/, IIB_Matcher_Toggle,
        testing::Combine(testing::Values((int)HierarchicalMatcher::EXACT, (int)HierarchicalMatcher::THRESHOLD,
                                 (int)HierarchicalMatcher::ADAPTIVE),
                testing::Bool(), testing::Bool()));

}}  // namespace opencv_test
