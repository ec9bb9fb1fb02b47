// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "../support/matcher_oracle.hpp"
#include "../../src/matcher/search_blocks.hpp"

namespace opencv_test {
namespace {

// Queries and train codes are scanned in blocks; blocks of 8 and of 1 make small data cross their boundaries.
typedef testing::TestWithParam<std::tuple<int, int>> IIB_Matcher_Blocks;  // block size, mode

void setBlocks(HierarchicalMatcher& matcher, int size)
{
    SearchBlocks blocks;
    blocks.queries = size;
    blocks.codeBlocks = size;
    dynamic_cast<BlockedMatcher&>(matcher).setSearchBlocks(blocks);
}

Ptr<HierarchicalMatcher> createMatcher(const MatcherOracle& oracle, int mode, int blocks)
{
    const Ptr<HierarchicalMatcher> matcher =
            HierarchicalMatcher::create(oracle.levelSizes, mode, 0.35f, oracle.crossCheck);
    setBlocks(*matcher, blocks);
    matcher->setMaxRatio(oracle.maxRatio);
    return matcher;
}

TEST_P(IIB_Matcher_Blocks, as_the_oracle)
{
    const int size = std::get<0>(GetParam()), mode = std::get<1>(GetParam());
    MatcherOracle oracle;
    oracle.levelSizes = {2, 8, 32};
    const int rows[] = {70, 0, 1, 37, 200};
    for (int i = 0; i < 5; i++)
        oracle.images.push_back(randomDescriptors(10 + i, rows[i], 42));
    const Mat queries = randomDescriptors(20, 45, 42);
    std::vector<Mat> masks;
    for (int i = 0; i < 5; i++)
        masks.push_back(i == 1 || i == 2 ? Mat() : randomMask(30 + i, queries.rows, rows[i], 0.5));
    if (mode == HierarchicalMatcher::THRESHOLD)
        oracle.thresholds.assign(2, 0.35f);
    oracle.adaptiveBlock = mode == HierarchicalMatcher::ADAPTIVE ? size * 16 : 0;

    for (int k : {1, 3, 400})
        for (int bits = 0; bits < 8; bits++)
        {
            SCOPED_TRACE(format("k %d, setting %d", k, bits));
            oracle.crossCheck = (bits & 1) != 0;
            oracle.masks = bits & 2 ? masks : std::vector<Mat>();
            oracle.maxRatio = bits & 4 ? 0.8f : 1.f;
            const Ptr<HierarchicalMatcher> matcher = createMatcher(oracle, mode, size);
            matcher->add(oracle.images);
            Matches actual;
            matcher->knnMatch(queries, actual, k, oracle.masks);
            oracle.compared = oracle.all = 0;
            expectEqual(oracle.knn(queries, k), actual);
            EXPECT_EQ(oracle.compared / oracle.all, matcher->matchCost());
            // clones keep the size of blocks
            matcher->clone(false)->knnMatch(queries, actual, k, oracle.masks);
            expectEqual(oracle.knn(queries, k), actual);
            if (k != 1 || mode == HierarchicalMatcher::ADAPTIVE)
                continue;
            for (float radius : {0.5f, 20.f, 60.9f, 1e9f})
            {
                matcher->radiusMatch(queries, actual, radius, oracle.masks);
                expectEqual(oracle.radius(queries, (int)std::min(radius, 1e6f)), actual);
            }
        }
}

INSTANTIATE_TEST_CASE_P(/**/, IIB_Matcher_Blocks,
        testing::Combine(testing::Values(1, 8, 128),
                testing::Values((int)HierarchicalMatcher::EXACT, (int)HierarchicalMatcher::THRESHOLD,
                        (int)HierarchicalMatcher::ADAPTIVE)));

// A pair just within ADAPTIVE's margin of the best one, and one just beyond: 1.75 sigma of 64 bits are 7.
TEST(IIB_Matcher_Adaptive, margin)
{
    Mat trains(3, 32, CV_8U, Scalar(0));  // the sample is bytes 0 to 3 and 16 to 19
    const Mat query = trains.row(0).clone();
    trains.row(0).colRange(4, 16).setTo(255);  // the best in the sample, the worst in all
    trains.row(1).col(0).setTo(127);           // 7 bits
    trains.row(2).col(0).setTo(255);           // 8 bits, but nearer than the first
    const Ptr<HierarchicalMatcher> matcher = HierarchicalMatcher::create({32}, HierarchicalMatcher::ADAPTIVE);
    Matches matches;
    matcher->knnMatch(query, trains, matches, 3);
    ASSERT_EQ(1u, matches.size());
    ASSERT_EQ(2u, matches[0].size());
    EXPECT_EQ(1, matches[0][0].trainIdx);
    EXPECT_EQ(0, matches[0][1].trainIdx);
}

}  // namespace
}  // namespace opencv_test
