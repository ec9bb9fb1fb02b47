// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "../support/matcher_oracle.hpp"
#include "../../src/matcher/kernels/hamming.hpp"

namespace opencv_test { namespace {

typedef std::vector<int> Levels;
typedef std::map<std::pair<int, int>, int> Distances;  // of (query, train code)

//! Everything a scan needs.
struct ScanData
{
    const HammingKernels& kernels;
    CodeLayout layout;
    Mat queries, trains;
    std::vector<unsigned> blocks;
    std::vector<int> queryThresholds, trainThresholds;

    ScanData(int bytes, int queryCount, int rows)
        : kernels(hammingKernels()), layout(Levels(1, bytes), kernels.packing),
          queries(randomDescriptors(1, queryCount, bytes)), trains(randomDescriptors(2, rows, bytes)),
          blocks((rows + 15) / 16 * layout.blockWords()), queryThresholds(queryCount, INT_MAX),
          trainThresholds((rows + 15) / 16 * 16, 0)
    {
        // All bits differ, for two queries that may share tables: the largest sums in bytes.
        queries.rowRange(0, std::min(queryCount, 2)).setTo(255);
        trains.row(3).setTo(0);
        trains.row(7).setTo(255);
        for (int i = 0; i < rows; i++)
            layout.store(trains.ptr(i), &blocks[i / 16 * layout.blockWords()], i % 16);
    }

    CodePairs pairs() const { return {layout, queries, blocks.data(), trains.rows, 0}; }
};

// Single codes, and whole blocks from rows that are not continuous.
TEST(IIB_Hamming, layout_comes_back)
{
    for (CodePacking packing : {PACKING_ADDERS, PACKING_TABLES})
        for (const Levels& levels :
                {Levels{1}, Levels{2, 8, 32, 128}, Levels{8, 24}, Levels{3, 5, 7}, Levels{4}})
        {
            const CodeLayout layout(levels, packing);
            const Mat wide = randomDescriptors(1, 16, layout.bytes() + 5),
                      descriptors = wide.colRange(3, 3 + layout.bytes()), descriptor = descriptors.row(5);
            std::vector<unsigned> block(layout.blockWords()), plain(layout.words());
            Mat back(1, layout.bytes(), CV_8U, Scalar(0));
            layout.store(descriptor.ptr(), block.data(), 5);
            layout.fetch(block.data(), 5, plain.data());
            layout.restore(plain.data(), back.ptr());
            EXPECT_EQ(0, cvtest::norm(descriptor, back, NORM_INF));
            EXPECT_EQ(8 * layout.bytes(), layout.bits(layout.words()));
            for (int level = 0, bits = 0; level + 1 < layout.levels(); level++)
                EXPECT_EQ(bits += 8 * levels[level], layout.bits(layout.end(level)));
            std::vector<unsigned> expected(layout.blockWords()), actual(layout.blockWords());
            for (int i = 0; i < 16; i++)
                layout.store(descriptors.ptr(i), expected.data(), i);
            layout.storeBlock(descriptors.ptr(), descriptors.step, actual.data());
            EXPECT_EQ(expected, actual);
        }
}

TEST(IIB_Hamming, last_level_begins_with_every_fourth_word)
{
    const CodeLayout layout({2, 32}, PACKING_TABLES);
    ASSERT_EQ(3, layout.segments());
    EXPECT_EQ(16 + 64, layout.bits(layout.end(1)));
    Mat descriptor(1, 34, CV_8U, Scalar(0));
    descriptor.colRange(2 + 16, 2 + 20).setTo(255);  // word 4 of the last level
    std::vector<unsigned> plain(layout.words());
    layout.arrange(descriptor.ptr(), plain.data());
    EXPECT_EQ((std::vector<unsigned>{0, 0, ~0u, 0, 0, 0, 0, 0, 0}), plain);
}

// Numbers of words whose sums exceed bytes and 16 bits; numbers of queries around that of a kernel; one block and several, the
// last one full or not; thresholds that about half the pairs and few pairs are below.
TEST(IIB_Hamming, scan_as_the_naive_loop)
{
    for (int bytes : {1, 4, 5, 12, 31, 32, 64, 68, 170, 248, 252, 256, 260, 682, 1000, 8200})
        for (int queryCount : {1, 2, 3, 4, 5, 8, 9})
            for (int below : {bytes * 4, bytes * 2})
                for (bool bothDirections : {false, true})
                {
                    ScanData data(bytes, queryCount, 16 + queryCount * 5);
                    std::fill(data.queryThresholds.begin(), data.queryThresholds.end(), below);
                    data.trainThresholds[3] = bytes * 8 + 1;
                    Distances expected, actual;
                    const auto found = [&](int query, int train, int distance) {
                        const Distances::const_iterator next = actual.lower_bound({query, train});
                        EXPECT_TRUE(next == actual.end() || next->first.first > query)
                                << "train codes not in ascending order";
                        actual[{query, train}] = distance;
                    };
                    data.kernels.pruned({data.pairs(), PruningPolicy(), data.queryThresholds.data(),
                            bothDirections ? data.trainThresholds.data() : 0, found, 0, 0});
                    for (int q = 0; q < queryCount; q++)
                        for (int t = 0; t < data.trains.rows; t++)
                        {
                            const int distance =
                                    hammingDistance(data.queries.ptr(q), data.trains.ptr(t), bytes);
                            if (distance < below || (bothDirections && t == 3))
                                expected[std::make_pair(q, t)] = distance;
                        }
                    ASSERT_EQ(expected, actual) << bytes << " bytes, " << queryCount << " queries, below "
                                                << below << ", both directions " << bothDirections;
                }
}

// One or two neighbours per query, and the nearest query of each train code; with ties, earlier neighbours and masks.
TEST(IIB_Hamming, nearest_as_the_naive_loop)
{
    for (int bytes : {1, 5, 32, 64, 68, 170})
        for (int rows : {16, 17, 31, 80, 400})
            for (int queryCount : {1, 4, 5, 9})
                for (int setting = 0; setting < 16; setting++)
                {
                    const bool both = (setting & 1) != 0, masked = (setting & 2) != 0,
                               before = (setting & 4) != 0;
                    const int count = setting & 8 ? 2 : 1;
                    SCOPED_TRACE(format(
                            "%d bytes, %d rows, %d queries, setting %d", bytes, rows, queryCount, setting));
                    const ScanData data(bytes, queryCount, rows);
                    Mat mask = Mat::ones(queryCount, (rows + 15) / 16 * 16, CV_8U);
                    if (masked)
                        mask = randomMask(5, mask.rows, mask.cols, 0.5);
                    const MatchKey start = before ? matchKey(bytes * 4, 0) : NO_MATCH;
                    const size_t firstQuery = 1000,  // and a number that takes more than an int
                            firstTrain = (size_t)std::min<uint64>(
                                    (uint64)1 << 33, std::numeric_limits<size_t>::max() / 2);
                    std::vector<MatchKey> ofQueries(queryCount * count, start), ofTrains(rows, start),
                            expectedOfQueries, expectedOfTrains = ofTrains;
                    for (int q = 0; q < queryCount; q++)
                    {
                        std::vector<MatchKey> all(count, start);
                        for (int t = 0; t < rows; t++)
                        {
                            const int d = hammingDistance(data.queries.ptr(q), data.trains.ptr(t), bytes);
                            if (!mask.at<uchar>(q, t))
                                continue;
                            all.push_back(matchKey(d, firstTrain + t));
                            if (both)
                                expectedOfTrains[t] =
                                        std::min(expectedOfTrains[t], matchKey(d, firstQuery + q));
                        }
                        std::sort(all.begin(), all.end());
                        expectedOfQueries.insert(expectedOfQueries.end(), all.begin(), all.begin() + count);
                    }
                    NearestScan scan = {data.pairs(), ofQueries.data(), count, both ? ofTrains.data() : 0,
                            firstQuery, firstTrain};
                    if (masked)
                        scan.pairs.allowed = mask.data;
                    data.kernels.nearest(scan);
                    EXPECT_EQ(expectedOfQueries, ofQueries);
                    EXPECT_EQ(expectedOfTrains, ofTrains);
                }
}

}}  // namespace opencv_test
