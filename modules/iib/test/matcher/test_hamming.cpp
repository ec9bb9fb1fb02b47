// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "../support/matcher_oracle.hpp"
#include "../../src/matcher/kernels/hamming.hpp"

namespace opencv_test {
namespace {

typedef std::vector<int> Levels;
typedef std::map<std::pair<int, int>, int> Distances;  // of (query, train code)

struct AllPairs : public HammingSink
{
    Distances distances;
    void found(int query, int train, int distance) CV_OVERRIDE
    {
        const Distances::const_iterator next = distances.lower_bound(std::make_pair(query, train));
        EXPECT_TRUE(next == distances.end() || next->first.first > query)
                << "train codes not in ascending order";
        distances[std::make_pair(query, train)] = distance;
    }
};

//! Everything a scan needs, and the naive distances.
struct ScanData
{
    CodeLayout layout;
    Mat queries, trains;
    std::vector<unsigned> plainQueries, plainTrains, groups;
    std::vector<int64> passed;
    std::vector<int> queryBelow, trainBelow;

    ScanData(const Levels& levels, int queryCount, int rows)
        : layout(levels, hammingPacking()), queries(randomDescriptors(1, queryCount, layout.bytes())),
          trains(randomDescriptors(2, rows, layout.bytes())), plainQueries(queryCount * layout.words()),
          plainTrains(rows * layout.words()), groups(rows * layout.words()), queryBelow(queryCount, INT_MAX),
          trainBelow(rows, 0)
    {
        CV_Assert(rows % CodeLayout::CODES_PER_BLOCK == 0);
        // All bits differ, for two queries that may share tables: what adds up in bytes is as large as can be.
        queries.rowRange(0, std::min(queryCount, 2)).setTo(255);
        trains.row(3).setTo(0);
        trains.row(7).setTo(255);
        for (int i = 0; i < queryCount; i++)
            layout.arrange(queries.ptr(i), &plainQueries[i * layout.words()]);
        for (int i = 0; i < rows; i++)
        {
            const int group = i / CodeLayout::CODES_PER_BLOCK * CodeLayout::CODES_PER_BLOCK;
            std::vector<unsigned> code(layout.words());
            layout.arrange(trains.ptr(i), code.data());
            std::copy(code.begin(), code.end(), plainTrains.begin() + i * layout.words());
            layout.store(code.data(), &groups[group * layout.words()], i % CodeLayout::CODES_PER_BLOCK);
        }
    }

    HammingScan scan(const std::vector<PruneStage>& stops, HammingSink& sink)
    {
        passed.assign(stops.size(), 0);
        HammingScan scan = HammingScan();
        scan.layout = &layout;
        scan.queries = plainQueries.data();
        scan.queryCount = queries.rows;
        scan.trains = groups.data();
        scan.groups = trains.rows / CodeLayout::CODES_PER_BLOCK;
        scan.stops = stops.data();
        scan.stopCount = (int)stops.size();
        scan.passed = passed.data();
        scan.margin = -1;
        scan.queryBelow = queryBelow.data();
        scan.trainBelow = trainBelow.data();
        scan.sink = &sink;
        return scan;
    }

    //! Bits that differ up to the end of a part.
    int distance(int query, int train, int part) const
    {
        return hammingDistance((const uchar*)&plainQueries[query * layout.words()],
                (const uchar*)&plainTrains[train * layout.words()], layout.end(part) * 4);
    }
};

TEST(IIB_Hamming, layout_comes_back)
{
    for (CodePacking packing : {PACKING_ADDERS, PACKING_TABLES})
        for (const Levels& levels :
                {Levels{1}, Levels{2, 8, 32, 128}, Levels{8, 24}, Levels{3, 5, 7}, Levels{4}})
        {
            const CodeLayout layout(levels, packing);
            const Mat descriptor = randomDescriptors(1, 1, layout.bytes());
            std::vector<unsigned> group(CodeLayout::CODES_PER_BLOCK * layout.words()), plain(layout.words());
            Mat back(1, layout.bytes(), CV_8U, Scalar(0));
            layout.arrange(descriptor.ptr(), plain.data());
            layout.store(plain.data(), group.data(), 5);
            std::fill(plain.begin(), plain.end(), 0u);
            layout.fetch(group.data(), 5, plain.data());
            layout.restore(plain.data(), back.ptr());
            EXPECT_EQ(0, cvtest::norm(descriptor, back, NORM_INF));
            int bits = 0;
            for (int part = 0; part < layout.parts(); part++)
                bits += layout.bits(part);
            EXPECT_EQ(8 * layout.bytes(), bits);
            for (int level = 0; level + 1 < layout.levels(); level++)
                EXPECT_EQ(8 * levels[level], layout.bits(level));
        }
}

TEST(IIB_Hamming, last_level_begins_with_every_fourth_word)
{
    const CodeLayout layout({2, 32}, PACKING_TABLES);
    ASSERT_EQ(3, layout.parts());
    EXPECT_EQ(64, layout.bits(1));
    Mat descriptor(1, 34, CV_8U, Scalar(0));
    descriptor.colRange(2 + 16, 2 + 20).setTo(255);  // word 4 of the last level
    std::vector<unsigned> plain(layout.words());
    layout.arrange(descriptor.ptr(), plain.data());
    EXPECT_EQ((std::vector<unsigned>{0, 0, ~0u, 0, 0, 0, 0, 0, 0}), plain);
}

// The whole kernel against a loop over bits: every number of words, more than fit a vector of bytes included,
// queries that do and do not fill a tile, one group and several; bounds that about half the pairs are within, and that
// hardly any is, so that tiles are left early.
TEST(IIB_Hamming, scan_as_the_naive_loop)
{
    for (int bytes : {1, 4, 5, 12, 31, 32, 64, 68, 170, 248, 252, 256, 260, 682, 1000})
        for (int queryCount : {1, 2, 3, 4, 5, 8, 9})
            for (int below : {bytes * 4, bytes * 2})
                for (bool bothDirections : {false, true})
                {
                    ScanData data(
                            Levels(1, bytes), queryCount, (1 + queryCount % 3) * CodeLayout::CODES_PER_BLOCK);
                    std::fill(data.queryBelow.begin(), data.queryBelow.end(), below);
                    data.trainBelow[3] = bytes * 8 + 1;
                    AllPairs sink;
                    HammingScan scan = data.scan(std::vector<PruneStage>(), sink);
                    if (!bothDirections)
                        scan.trainBelow = 0;
                    hammingScan(scan);
                    Distances expected;
                    for (int q = 0; q < queryCount; q++)
                        for (int t = 0; t < data.trains.rows; t++)
                        {
                            const int distance =
                                    hammingDistance(data.queries.ptr(q), data.trains.ptr(t), bytes);
                            if (distance < below || (bothDirections && t == 3))
                                expected[std::make_pair(q, t)] = distance;
                        }
                    ASSERT_EQ(expected, sink.distances)
                            << bytes << " bytes, " << queryCount << " queries, below " << below
                            << ", both directions " << bothDirections;
                }
}

// Levels that end one soon after the other and far apart, bounds that hardly any pair and that most pairs pass.
TEST(IIB_Hamming, stops_as_the_naive_loop)
{
    for (const Levels& levels : {Levels{2, 8, 32, 128}, Levels{16, 48}, Levels{40, 40, 40}})
        for (int share : {0, 10, 25, 35, 50, 100})
            for (int masked = 0; masked < 2; masked++)
            {
                SCOPED_TRACE(
                        format("%d levels, %d %% of the bits, masked %d", (int)levels.size(), share, masked));
                ScanData data(levels, 9, 6 * CodeLayout::CODES_PER_BLOCK);
                std::vector<PruneStage> stops;
                for (int level = 0; level + 1 < (int)levels.size(); level++)
                    stops.push_back(PruneStage{level, levels[level] * 8 * share / 100});
                const Mat mask = randomMask(3, data.queries.rows, data.trains.rows, 0.7);
                AllPairs sink;
                HammingScan scan = data.scan(stops, sink);
                scan.allowed = masked ? mask.data : 0;
                hammingScan(scan);
                Distances expected;
                std::vector<int64> passed(stops.size(), 0);
                for (int q = 0; q < data.queries.rows; q++)
                    for (int t = 0; t < data.trains.rows; t++)
                    {
                        size_t stop = 0;
                        if (masked && !mask.at<uchar>(q, t))
                            continue;
                        for (int before = 0; stop < stops.size(); stop++)
                        {
                            const int distance = data.distance(q, t, stops[stop].part);
                            if (distance - before > stops[stop].most)
                                break;
                            before = distance;
                            passed[stop]++;
                        }
                        if (stop == stops.size())
                            expected[std::make_pair(q, t)] = data.distance(q, t, data.layout.parts() - 1);
                    }
                EXPECT_EQ(expected, sink.distances);
                EXPECT_EQ(passed, data.passed);
            }
}

// A single stop with limits, as they are and lowered by a margin.
TEST(IIB_Hamming, limits_as_the_naive_loop)
{
    for (int margin : {-1, 0, 10, 40, 400})
    {
        SCOPED_TRACE(margin);
        ScanData data({2, 8, 32, 128}, 7, 8 * CodeLayout::CODES_PER_BLOCK);
        const std::vector<PruneStage> stops(1, PruneStage{3, PruneStage::NO_MAX});
        std::vector<int> limits(data.queries.rows), expectedLimits;
        for (size_t q = 0; q < limits.size(); q++)
            limits[q] = 60 + 60 * (int)q;
        expectedLimits = limits;
        AllPairs sink;
        HammingScan scan = data.scan(stops, sink);
        scan.limits = limits.data();
        scan.margin = margin;
        hammingScan(scan);
        Distances expected;
        for (int q = 0; q < data.queries.rows; q++)
        {
            for (int t = 0; margin >= 0 && t < data.trains.rows; t++)
                expectedLimits[q] = std::min(expectedLimits[q], data.distance(q, t, 3) + margin);
            for (int t = 0; t < data.trains.rows; t++)
                if (data.distance(q, t, 3) <= expectedLimits[q])
                    expected[std::make_pair(q, t)] = data.distance(q, t, 4);
        }
        EXPECT_EQ(expected, sink.distances);
        EXPECT_EQ(expectedLimits, limits);
        EXPECT_EQ((int64)expected.size(), data.passed[0]);
    }
}

}  // namespace
}  // namespace opencv_test
