// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "../support/matcher_oracle.hpp"

namespace opencv_test { namespace {

// Small chunks, so that small data crosses their boundaries.
typedef testing::TestWithParam<std::tuple<int, int>> IIB_Matcher_Chunks;  // size of a chunk, mode

//! The k nearest, and the share of bits that were compared.
void expectSearchedAsOracle(MatcherOracle& oracle, const Mat& queries, int k, const ScanChunk& chunk)
{
    SearchCost cost;
    const Matches actual = searched(oracle, queries, k, 0, chunk, cost);
    oracle.compared = oracle.all = 0;
    expectEqual(oracle.knn(queries, k), actual);
    EXPECT_EQ(oracle.compared, (double)cost.compared);
    EXPECT_EQ(oracle.all, (double)cost.all);
}

TEST_P(IIB_Matcher_Chunks, as_the_oracle)
{
    const int size = std::get<0>(GetParam()), mode = std::get<1>(GetParam());
    MatcherOracle oracle = oracleOfSeveralImages();
    const Mat queries = randomDescriptors(20, 45, 42);
    const std::vector<Mat> masks = masksOfSeveralImages(oracle, queries.rows);
    if (mode == HierarchicalMatcher::THRESHOLD)
        oracle.thresholds.assign(2, 0.35f);
    oracle.adaptiveBlock = mode == HierarchicalMatcher::ADAPTIVE ? size * 16 : 0;
    ScanChunk chunk;
    chunk.queryCount = chunk.codeBlocks = chunk.codeBlocksOfLimits = size;

    for (int k : {1, 2, 3, 400})
        for (int bits = 0; bits < 8; bits++)
        {
            SCOPED_TRACE(format("k %d, setting %d", k, bits));
            oracle.crossCheck = (bits & 1) != 0;
            oracle.masks = bits & 2 ? masks : std::vector<Mat>();
            oracle.maxRatio = bits & 4 ? 0.8f : 1.f;
            expectSearchedAsOracle(oracle, queries, k, chunk);
            SearchCost cost;
            for (int radius : {0, 20, 60, 336})
                if (k == 1 && mode != HierarchicalMatcher::ADAPTIVE)
                    expectEqual(oracle.radius(queries, radius),
                            searched(oracle, queries, 0, radius, chunk, cost));
        }
}

INSTANTIATE_TEST_CASE_P(/**/, IIB_Matcher_Chunks,
        testing::Combine(testing::Values(1, 8, 128),
                testing::Values((int)HierarchicalMatcher::EXACT, (int)HierarchicalMatcher::THRESHOLD,
                        (int)HierarchicalMatcher::ADAPTIVE)));

// Results of ADAPTIVE do not depend on the chunks for the cache, but on groups of 2048 codes.
TEST(IIB_Matcher_Adaptive, does_not_depend_on_chunks)
{
    const Mat queries = randomDescriptors(1, 30, 64), trains = randomDescriptors(2, 5000, 64);
    MatcherOracle oracle;
    oracle.levelSizes = {16, 48};
    oracle.images.push_back(trains);
    oracle.adaptiveBlock = 2048;
    for (int size : {1, 100, 1000})
    {
        ScanChunk chunk;
        chunk.queryCount = chunk.codeBlocks = size;
        expectSearchedAsOracle(oracle, queries, 5, chunk);
    }
}

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

}}  // namespace opencv_test
