// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "../support/textures.hpp"

#include "../../src/descriptor/keypoint_batches.hpp"

#include <numeric>

namespace opencv_test { namespace {

using cv::iib::KeyPointBatch;
typedef std::vector<Rect> Regions;

Rect unionOf(const Regions& regions, const std::vector<int>& members)
{
    Rect all = regions[members[0]];
    for (int k : members)
        all |= regions[k];
    return all;
}

//! Batches of all regions.
std::vector<std::vector<int>> cutBatches(const Regions& regions, int workers)
{
    std::vector<int> all(regions.size());
    std::iota(all.begin(), all.end(), 0);
    return cv::iib::cutBatches(regions, all, workers);
}

//! Every keypoint once, whatever the number of workers.
void expectPartition(const Regions& regions)
{
    for (int workers : {1, 2, 7})
    {
        std::vector<int> seen(regions.size(), 0);
        for (const std::vector<int>& members : cutBatches(regions, workers))
        {
            ASSERT_FALSE(members.empty());
            for (int k : members)
                seen[k]++;
        }
        EXPECT_EQ(std::vector<int>(regions.size(), 1), seen) << workers;
    }
}

Regions randomRegions(int count, Size image, int side, int seed)
{
    Integers random(seed);
    Regions regions;
    for (int i = 0; i < count; i++)
    {
        const int w = random.between(1, side + 1), h = random.between(1, side + 1);
        const int y = random.below(image.height - h), x = random.below(image.width - w);
        regions.push_back(Rect(x, y, w, h));
    }
    return regions;
}

TEST(IIB_KeyPointBatches, every_keypoint_is_in_one_batch)
{
    EXPECT_TRUE(cutBatches(Regions(), 2).empty());
    for (int count : {1, 2, 3, 17, 200})
        for (int side : {1, 5, 60})
            expectPartition(randomRegions(count, Size(300, 200), side, count + side));
}

TEST(IIB_KeyPointBatches, keypoints_that_are_not_asked_for_stay_out)
{
    const Regions regions = randomRegions(60, Size(300, 200), 30, 5);
    std::vector<int> even, found;
    for (int k = 0; k < 60; k += 2)
        even.push_back(k);
    for (const std::vector<int>& members : cv::iib::cutBatches(regions, even, 3))
        found.insert(found.end(), members.begin(), members.end());
    std::sort(found.begin(), found.end());
    EXPECT_EQ(even, found);
}

// Every row and column of a batch is covered by a region.
TEST(IIB_KeyPointBatches, gaps_cut_batches)
{
    for (int seed = 0; seed < 50; seed++)
    {
        const Regions regions = randomRegions(12, Size(300, 200), 40, seed);
        for (const std::vector<int>& members : cutBatches(regions, 1))
        {
            const Rect all = unionOf(regions, members);
            for (int x = all.x; x < all.br().x; x++)
                EXPECT_TRUE(std::any_of(members.begin(), members.end(),
                        [&](int k) { return regions[k].x <= x && x < regions[k].br().x; }));
            for (int y = all.y; y < all.br().y; y++)
                EXPECT_TRUE(std::any_of(members.begin(), members.end(),
                        [&](int k) { return regions[k].y <= y && y < regions[k].br().y; }));
        }
    }
}

TEST(IIB_KeyPointBatches, batch_holds_its_regions_in_the_order_of_bands)
{
    for (int seed = 0; seed < 20; seed++)
    {
        const Regions regions = randomRegions(60, Size(300, 200), 50, seed);
        std::vector<int> members;
        for (int k = seed % 3; k < 60; k += 2)
            members.push_back(k);
        const KeyPointBatch batch = cv::iib::makeBatch(regions, members);
        EXPECT_EQ(unionOf(regions, members), batch.area);
        int rows = 0, lastBand = 0, lastX = 0;
        std::vector<int> sorted = batch.keypoints;
        for (int k : batch.keypoints)
        {
            const Rect& r = regions[k];
            rows = std::max(rows, r.height);
            const int end = batch.bandEnd(r.br().y);
            EXPECT_GE(end, r.br().y);
            EXPECT_LE(end, std::min(r.br().y + KeyPointBatch::BAND_ROWS - 1, batch.area.br().y));
            EXPECT_GE(end, lastBand);
            EXPECT_TRUE(end != lastBand || end == batch.area.br().y || r.x >= lastX);
            lastBand = end;
            lastX = r.x;
        }
        EXPECT_EQ(rows, batch.rows);
        std::sort(sorted.begin(), sorted.end());
        EXPECT_EQ(members, sorted);
    }
}

/* Layouts of n regions on an image whose sides grow as the root of n. */
Regions grid(int n, Size image)
{
    const int columns = cvRound(std::sqrt((double)n));
    Regions regions;
    for (int i = 0; i < n; i++)
        regions.push_back(
                Rect(i % columns * (image.width / columns), i / columns * (image.height / columns), 4, 4));
    return regions;
}

//! A horizontal bar at the top, a vertical bar at the left of the rest, and so on.
Regions staircase(int n, Size image)
{
    const int steps = std::min(image.width, image.height) / 8;
    Regions regions;
    for (int s = 0; s < steps; s++)
    {
        const int at = 8 * s;
        for (int i = 0; i < std::max(1, n / steps / 2); i++)
        {
            regions.push_back(Rect(at, at, image.width - at, 3));
            regions.push_back(Rect(at, at + 4, 3, image.height - at - 4));
        }
    }
    return regions;
}

Regions cluster(int n, Size image) { return randomRegions(n, Size(image.width / 4, image.height / 4), 9, n); }

// Each round visits each keypoint once. Recursion without a limit took 10.4 s and 2 GB for 202,626 keypoints.
TEST(IIB_KeyPointBatches, rounds_and_pixels_are_bounded_for_every_layout)
{
    for (const auto layout : {grid, staircase, cluster})
        for (int root : {25, 50, 100, 200, 450})
        {
            const Size image(20 * root, 20 * root);
            const Regions regions = layout(root * root, image);
            const std::vector<std::vector<int>> batches = cutBatches(regions, 1);
            double pixels = 0;
            for (const std::vector<int>& members : batches)
                pixels += unionOf(regions, members).area();
            EXPECT_LE(pixels, 1.01 * image.area()) << regions.size();
            if (layout == staircase)  // each round cuts off one step
            {
                EXPECT_EQ(cv::iib::MAX_CUTS + 1u, batches.size());
            }
        }
}

}}  // namespace opencv_test
