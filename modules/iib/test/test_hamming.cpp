// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "matcher_oracle.hpp"
#include "../src/hamming.hpp"

namespace opencv_test {
namespace {

struct AllPairs : public HammingSink
{
    std::map<std::pair<int, int>, int> distances;
    void found(int query, int train, int distance) CV_OVERRIDE
    {
        EXPECT_TRUE(distances.insert(std::make_pair(std::make_pair(query, train), distance)).second);
    }
};

typedef std::vector<int> Levels;

TEST(IIB_Hamming, layout_comes_back_and_ends_levels_at_steps)
{
    for (const Levels& levels : { Levels{ 1 }, Levels{ 2, 8, 32, 128 }, Levels{ 8, 24 }, Levels{ 3, 5, 7 }, Levels{ 4 } })
    {
        const HammingLayout layout(levels);
        const Mat descriptor = randomDescriptors(1, 1, layout.bytes());
        std::vector<unsigned> code(layout.words());
        Mat back(1, layout.bytes(), CV_8U);
        layout.pack(descriptor.ptr(), code.data());
        layout.unpack(code.data(), back.ptr());
        EXPECT_EQ(0, cvtest::norm(descriptor, back, NORM_INF));
        int bits = 0;
        for (int i = 0; i < layout.levels(); i++)
            EXPECT_EQ(bits += 8 * levels[i], layout.bits(layout.end(i)));
    }
    EXPECT_EQ(43, HammingLayout(Levels{ 2, 8, 32, 128 }).words());
    EXPECT_EQ(336 + 9 * 64, HammingLayout(Levels{ 2, 8, 32, 128 }).bits(5 + 9));
}

// The whole kernel against a loop over bits: every number of steps, chunks of more than 31 included, queries
// that do and do not fill a tile, one group and several.
TEST(IIB_Hamming, scan_as_the_naive_loop)
{
    for (int bytes : { 1, 4, 5, 12, 31, 32, 64, 170, 248, 252, 256, 260, 682, 1000 })
        for (int queryCount : { 1, 2, 3, 4, 5, 8, 9 })
        {
            const HammingLayout layout(Levels(1, bytes));
            const int groups = 1 + queryCount % 3, rows = groups * HammingLayout::LANES;
            const Mat queries = randomDescriptors(1, queryCount, bytes), trains = randomDescriptors(2, rows, bytes);
            std::vector<unsigned> code(layout.words()), packed, blocks((size_t)rows * layout.words());
            for (int i = 0; i < queryCount; i++)
            {
                layout.pack(queries.ptr(i), code.data());
                packed.insert(packed.end(), code.begin(), code.end());
            }
            for (int i = 0; i < rows; i++)
            {
                layout.pack(trains.ptr(i), code.data());
                for (int w = 0; w < layout.words(); w++)
                    blocks[((i / 16) * layout.words() + w) * 16 + i % 16] = code[w];
            }
            const std::vector<int> queryBelow(queryCount, bytes * 4), trainBelow(rows, 0);
            AllPairs sink;
            HammingScan scan = HammingScan();
            scan.steps = layout.steps();
            scan.queries = packed.data();
            scan.queryCount = queryCount;
            scan.trains = blocks.data();
            scan.groups = groups;
            scan.queryBelow = queryBelow.data();
            scan.trainBelow = trainBelow.data();
            scan.sink = &sink;
            hammingScan(scan);
            for (int q = 0; q < queryCount; q++)
                for (int t = 0; t < rows; t++)
                {
                    const int distance = hammingDistance(queries.ptr(q), trains.ptr(t), bytes);
                    const auto found = sink.distances.find(std::make_pair(q, t));
                    ASSERT_EQ(distance < bytes * 4, found != sink.distances.end());
                    ASSERT_TRUE(found == sink.distances.end() || found->second == distance);
                }
        }
}

// Pinned by OPENCV_CPU_DISABLE, the kernel must be the best one of what is left.
TEST(IIB_Hamming, runs_on_the_widest_instruction_set_left)
{
    const String running = hammingInstructionSet();
    std::cout << "[          ] Hamming kernel: " << running << std::endl;
#if defined(__x86_64__) || defined(_M_X64)
    String widest = "baseline";
    if (checkHardwareSupport(CPU_SSE4_2) && checkHardwareSupport(CPU_POPCNT))
        widest = "SSE4_2";
    if (widest != "baseline" && checkHardwareSupport(CPU_AVX2) && checkHardwareSupport(CPU_FMA3))
        widest = "AVX2";
    if (widest == "AVX2" && checkHardwareSupport(CPU_AVX512_SKX))
        widest = checkHardwareSupport(CPU_AVX512_ICL) ? "AVX512_ICL" : "AVX512_SKX";
    EXPECT_EQ(widest, running);
#endif
}

}  // namespace
}  // namespace opencv_test
