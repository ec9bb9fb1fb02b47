// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "../support/matcher_oracle.hpp"

namespace opencv_test {
namespace {

TEST(IIB_MatcherClone, keeps_parameters)
{
    const Ptr<HierarchicalMatcher> matcher = HierarchicalMatcher::create({2, 8, 32});
    matcher->add(randomDescriptors(1, 5, 42));
    matcher->setMode(HierarchicalMatcher::THRESHOLD);
    matcher->setThresholds({0.1f, 0.2f});
    matcher->setCrossCheck(true);
    matcher->setMaxRatio(0.5f);
    for (bool empty : {false, true})
    {
        const Ptr<HierarchicalMatcher> copy = matcher->copy(empty);
        expectSameParameters(*matcher, *copy);
        EXPECT_EQ(empty, copy->empty());
    }
}

// What either adds or clears is not in the other's packed codes, nor in its matrices; 5 rows and 6 more are in one
// CodeBlock, 20 more need new memory.
typedef testing::TestWithParam<int> IIB_MatcherClone_Rows;
TEST_P(IIB_MatcherClone_Rows, are_not_shared)
{
    const int rows = GetParam();
    const Mat first = randomDescriptors(1, 5, 42), second = randomDescriptors(2, rows, 42),
              third = randomDescriptors(3, rows, 42);
    for (bool originalChanges : {false, true})
    {
        const Ptr<HierarchicalMatcher> matcher = HierarchicalMatcher::create({2, 8, 32});
        matcher->add(first);
        const Ptr<HierarchicalMatcher> copy = matcher->copy();
        HierarchicalMatcher &changed = originalChanges ? *matcher : *copy,
                            &same = originalChanges ? *copy : *matcher;
        changed.add(second);
        Matches expected, actual;
        HierarchicalMatcher::create({2, 8, 32})->knnMatch(second, first, expected, 30);
        same.knnMatch(second, actual, 30);
        expectEqual(expected, actual);
        ASSERT_EQ(1u, same.getTrainDescriptors().size());

        // in the same places of memory, were they shared
        same.add(third);
        std::vector<DMatch> best;
        changed.match(second, best);
        ASSERT_EQ((size_t)rows, best.size());
        for (int q = 0; q < rows; q++)
            EXPECT_EQ(0, best[q].distance);
        EXPECT_EQ(0, cvtest::norm(third, same.getTrainDescriptors()[1], NORM_INF));
        EXPECT_EQ(0, cvtest::norm(second, changed.getTrainDescriptors()[1], NORM_INF));

        changed.getTrainDescriptors()[0].setTo(0);
        EXPECT_EQ(0, cvtest::norm(first, same.getTrainDescriptors()[0], NORM_INF));
        EXPECT_EQ(0, cvtest::norm(first, changed.getTrainDescriptors()[0], NORM_INF));
        changed.clear();
        EXPECT_TRUE(changed.empty());
        EXPECT_EQ(2u, same.getTrainDescriptors().size());
    }
}

INSTANTIATE_TEST_CASE_P(/**/, IIB_MatcherClone_Rows, testing::Values(6, 20));

// Fresh, with images that have no rows, and cleared.
TEST(IIB_MatcherClone, of_a_matcher_without_rows)
{
    const Mat codes = randomDescriptors(1, 5, 42);
    for (int setting = 0; setting < 3; setting++)
    {
        SCOPED_TRACE(setting);
        const Ptr<HierarchicalMatcher> matcher = HierarchicalMatcher::create({2, 8, 32});
        if (setting > 0)
            matcher->add(setting == 1 ? Mat() : codes);
        if (setting == 2)
            matcher->clear();
        Ptr<HierarchicalMatcher> copy;
        ASSERT_NO_THROW(copy = matcher->copy());
        ASSERT_NO_THROW(matcher->clone(false));
        EXPECT_EQ(matcher->getTrainDescriptors().size(), copy->getTrainDescriptors().size());
        EXPECT_EQ(matcher->levelSizes(), copy->levelSizes());
        copy->add(codes);
        std::vector<DMatch> matches;
        copy->match(codes, matches);
        EXPECT_EQ(5u, matches.size());
        EXPECT_TRUE(matcher->empty() || setting == 1);
    }
}

TEST(IIB_MatcherClone, empty_clones_count_for_the_original)
{
    const Ptr<HierarchicalMatcher> matcher = HierarchicalMatcher::create({2, 8, 32});
    const Mat codes = randomDescriptors(1, 5, 42);
    matcher->add(codes);
    Matches matches;
    matcher->clone(false)->knnMatch(codes, matches, 1);
    EXPECT_EQ(0, matcher->matchCost());
    static_cast<DescriptorMatcher&>(*matcher).knnMatch(codes, codes, matches, 1);
    EXPECT_EQ(1, matcher->matchCost());
}

}  // namespace
}  // namespace opencv_test
