// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "../support/test_errors.hpp"
#include "../../src/matcher/knn_table.hpp"

namespace opencv_test {
namespace {

// Rows of keys, sorted and cut: what a table of neighbours is.
struct NaiveTable
{
    std::vector<std::vector<MatchKey>> rows;
    const size_t k;
    NaiveTable(size_t rows_, int k_) : rows(rows_), k(k_) {}
    void insert(size_t row, MatchKey n)
    {
        rows[row].push_back(n);
        std::sort(rows[row].begin(), rows[row].end());
        if (rows[row].size() > k)
            rows[row].pop_back();
    }
};

void expectEqual(const NaiveTable& expected, const KnnTable& actual)
{
    ASSERT_EQ(expected.rows.size(), actual.rows());
    for (size_t row = 0; row < actual.rows(); row++)
    {
        std::vector<MatchKey> padded = expected.rows[row];
        padded.resize(expected.k, NO_MATCH);
        ASSERT_EQ(padded, std::vector<MatchKey>(actual[row], actual[row] + actual.size())) << "row " << row;
        ASSERT_EQ(padded.back() == NO_MATCH ? INT_MAX : distanceOf(padded.back()), actual.thresholds()[row])
                << "row " << row;
    }
}

TEST(IIB_KnnTable, keys_order_by_distance_then_index)
{
    const size_t large = ((size_t)1 << INDEX_BITS) - 1;
    EXPECT_EQ(12345, distanceOf(matchKey(12345, large)));
    EXPECT_EQ(large, indexOf(matchKey(12345, large)));
    EXPECT_LT(matchKey(7, large), matchKey(8, 0));
    EXPECT_LT(matchKey(7, 3), matchKey(7, 4));
    EXPECT_LT(matchKey(8 << 20, large), NO_MATCH);
}

TEST(IIB_KnnTable, insert_and_merge_as_the_naive_table)
{
    RNG rng(1);
    for (int k : {1, 2, 3, 8, 40})
    {
        const int rows = 7;
        KnnTable first(rows, k), second(rows, k, 16);
        NaiveTable naiveFirst(rows, k), naiveSecond(rows, k), merged(rows, k);
        expectEqual(merged, first);
        for (int i = 0; i < 60 * rows; i++)
        {
            // few distances, so that ties are many; no index twice
            const size_t row = rng.uniform(0, rows - 1);  // the last row stays empty
            const MatchKey n = matchKey(rng.uniform(0, 9), (size_t)(i * 7919) % 100003);
            (i % 3 ? first : second).insert(row, n);
            (i % 3 ? naiveFirst : naiveSecond).insert(row, n);
            merged.insert(row, n);
            expectEqual(i % 3 ? naiveFirst : naiveSecond, i % 3 ? first : second);
        }
        first.merge(second);
        expectEqual(merged, first);
        for (int i = 0; i < 16; i++)
            EXPECT_EQ(INT_MAX, second.thresholds()[rows + i]);
    }
}

TEST(IIB_KnnTable, what_memory_cannot_hold_is_an_error_that_names_k)
{
    expectError(Error::StsNoMem, format("k is %d", INT_MAX), [] { KnnTable(INT_MAX, INT_MAX); });
    expectError(
            Error::StsNoMem, format("k is %d", INT_MAX), [] { forNeighbours<int64>(INT_MAX, INT_MAX, -1); });
}

}  // namespace
}  // namespace opencv_test
