// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "../support/matcher_oracle.hpp"
#include "../../src/matcher/kernels/hamming.hpp"

namespace opencv_test {
namespace {

//! Restores cv::useOptimized() at the end of a test.
struct OptimizationToggle
{
    const bool before;
    OptimizationToggle() : before(useOptimized()) {}
    ~OptimizationToggle() { setUseOptimized(before); }
};

// Codes are packed for the instruction set at hand when they are added; a later change of it must not matter.
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

}  // namespace
}  // namespace opencv_test
