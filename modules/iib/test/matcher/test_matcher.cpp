// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "../support/matcher_oracle.hpp"

#include <numeric>

namespace opencv_test { namespace {

// Levels of 1/8, 1/4 and the rest of a descriptor.
std::vector<int> levelsOf(int bytes)
{
    std::vector<int> levels;
    if (bytes >= 8)
    {
        levels.push_back(bytes / 8);
        levels.push_back(bytes / 4);
        bytes -= bytes / 8 + bytes / 4;
    }
    levels.push_back(bytes);
    return levels;
}

typedef testing::TestWithParam<std::tuple<int, int>> IIB_Matcher_Sizes;  // train rows, bytes

TEST_P(IIB_Matcher_Sizes, as_BFMatcher)
{
    const int rows = std::get<0>(GetParam()), bytes = std::get<1>(GetParam());
    const Mat train = randomDescriptors(1, rows, bytes),
              queries = randomDescriptors(2, rows > 100 ? 61 : rows, bytes);
    const Ptr<HierarchicalMatcher> matcher = HierarchicalMatcher::create(levelsOf(bytes));
    if (rows == 0)
    {
        Matches matches(1);
        matcher->knnMatch(randomDescriptors(2, 5, bytes), train, matches, 2);
        expectEqual(Matches(5), matches);
        return;
    }
    Matches expected, actual;
    const Mat mask = randomMask(3, queries.rows, train.rows, 0.6);
    for (int k = 1; k <= 3; k++)
        for (bool masked : {false, true})
        {
            expected.clear();  // BFMatcher appends
            BFMatcher(NORM_HAMMING).knnMatch(queries, train, expected, k, masked ? mask : Mat(), masked);
            matcher->knnMatch(queries, train, actual, k, masked ? mask : Mat(), masked);
            expectEqual(expected, actual);
        }
    for (int radius = 1; radius < bytes * 8; radius = radius * 3 + 1)
    {
        expected.clear();
        BFMatcher(NORM_HAMMING).radiusMatch(queries, train, expected, (float)radius);
        matcher->radiusMatch(queries, train, actual, (float)radius);
        ASSERT_EQ(expected.size(), actual.size());
        for (size_t q = 0; q < expected.size(); q++)
            EXPECT_EQ(expected[q].size(), actual[q].size());
    }
    std::vector<DMatch> mutual, found;
    BFMatcher(NORM_HAMMING, true).match(queries, train, mutual);
    matcher->setCrossCheck(true);
    matcher->match(queries, train, found);
    expectEqual(Matches(1, mutual), Matches(1, found));
}

INSTANTIATE_TEST_CASE_P(/**/, IIB_Matcher_Sizes,
        testing::Combine(testing::Values(0, 1, 7, 8, 9, 63, 64, 65, 1000),
                testing::Values(1, 2, 10, 32, 43, 61, 64, 170, 682)));

// Several images, one of them empty, with all combinations of settings.
TEST(IIB_Matcher, all_together_as_the_oracle)
{
    MatcherOracle oracle = oracleOfSeveralImages();
    const Mat queries = randomDescriptors(20, 90, 42);
    const std::vector<Mat> masks = masksOfSeveralImages(oracle, queries.rows);

    for (int k : {1, 2, 5, 400})
        for (int bits = 0; bits < 16; bits++)
        {
            SCOPED_TRACE(format("k %d, setting %d", k, bits));
            oracle.crossCheck = (bits & 1) != 0;
            oracle.masks = bits & 2 ? masks : std::vector<Mat>();
            oracle.maxRatio = bits & 4 ? 0.8f : 1.f;
            oracle.thresholds = bits & 8 ? std::vector<float>(2, 0.35f) : std::vector<float>();
            const Ptr<HierarchicalMatcher> matcher = oracle.matcher();
            expectKnnAsOracle(*matcher, oracle, queries, k);
            Matches within;
            for (float radius : {0.5f, 20.f, 60.9f, 1e9f})  // from less than any distance to more than any
                if (k == 1)
                {
                    matcher->radiusMatch(queries, within, radius, oracle.masks);
                    expectEqual(oracle.radius(queries, (int)std::min(radius, 1e6f)), within);
                }
        }
}

// Small and large levels; thresholds that few and most pairs pass.
TEST(IIB_Matcher, any_thresholds_as_the_oracle)
{
    for (const std::vector<int>& levels :
            {std::vector<int>{2, 8, 32, 128}, std::vector<int>{16, 48}, std::vector<int>{40, 40, 40}})
        for (float threshold : {0.f, 0.1f, 0.25f, 0.35f, 0.5f, 1.f})
            for (bool masked : {false, true})
            {
                SCOPED_TRACE(format("%d levels, %g, masked %d", (int)levels.size(), threshold, masked));
                const int bytes = std::accumulate(levels.begin(), levels.end(), 0), rows = 91;
                MatcherOracle oracle;
                oracle.levelSizes = levels;
                oracle.thresholds.assign(levels.size() - 1, threshold);
                oracle.images.push_back(randomDescriptors(2, rows, bytes));
                if (masked)
                    oracle.masks.push_back(randomMask(3, 9, rows, 0.7));
                expectKnnAsOracle(*oracle.matcher(), oracle, randomDescriptors(1, 9, bytes), rows);
            }
}

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

// With 6 rows more, all codes are in one CodeBlock; 20 more need new memory.
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

        // would overwrite shared memory
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

}}  // namespace opencv_test
