// SPDX-License-Identifier: Apache-2.0

#include "index_fixture.hpp"

namespace opencv_test { namespace {

struct IIB_MappedIndex : public IndexFixture
{
};

TEST_F(IIB_MappedIndex, finds_what_brute_force_finds)
{
    const Ptr<MappedIndex> opened = MappedIndex::open(folder.name);
    EXPECT_EQ(LEVELS, opened->levelSizes());
    EXPECT_EQ(8, opened->images());
    EXPECT_EQ(2163, opened->rows());
    EXPECT_EQ(4, opened->segments());
    for (int k : {1, 3, 70, 2200})
    {
        SCOPED_TRACE(k);
        EXPECT_TRUE(expected(images, queries, k) == search(*opened, queries, k));
        EXPECT_TRUE(expected(images, queries, k) == search(*index, queries, k));
    }
    EXPECT_TRUE(search(*opened, Mat(), 3).rows.empty());
}

TEST_F(IIB_MappedIndex, one_segment_alone)
{
    EXPECT_EQ(std::vector<int64>(queries.rows, 57), search(*index, queries, 1, 1).rows);
    EXPECT_EQ(std::vector<int64>(queries.rows * 2, -1), search(*index, queries, 2, 2).rows);
    EXPECT_THROW(search(*index, queries, 1, 4), cv::Exception);
    EXPECT_THROW(search(*index, queries, 0), cv::Exception);
    EXPECT_THROW(search(*index, queries.colRange(0, 41), 1), cv::Exception);
}

// The rows and distances of a billion neighbours would take 12 GB for each query.
TEST_F(IIB_MappedIndex, more_neighbours_than_there_can_be_are_refused)
{
    expectError(Error::StsOutOfRange, "k is 1000000000, but there are 2163 descriptors",
            [&] { search(*index, queries, 1000000000); });
}

TEST_F(IIB_MappedIndex, codes_and_queries_may_be_views)
{
    Mat wide(queries.rows, queries.cols + 9, CV_8U, Scalar(7));
    queries.copyTo(wide.colRange(4, 4 + queries.cols));
    const Mat view = wide.colRange(4, 4 + queries.cols);
    EXPECT_TRUE(search(*index, queries, 3) == search(*index, view, 3));
    index->add(view);
    EXPECT_EQ(0, cvtest::norm(queries, index->descriptors(8), NORM_INF));
}

TEST_F(IIB_MappedIndex, images_and_rows)
{
    int64 row = 0;
    for (int image = 0; image < (int)images.size(); row += images[image++].rows)
    {
        EXPECT_EQ(row, index->firstRow(image));
        EXPECT_EQ(0, cvtest::norm(images[image], index->descriptors(image), NORM_INF));
        if (images[image].rows > 0)
        {
            EXPECT_EQ(image, index->imageOf(row));
            EXPECT_EQ(image, index->imageOf(row + images[image].rows - 1));
        }
    }
    EXPECT_THROW(index->imageOf(row), cv::Exception);
    EXPECT_THROW(index->imageOf(-1), cv::Exception);
    EXPECT_THROW(index->firstRow(8), cv::Exception);
}

TEST_F(IIB_MappedIndex, removed_images_are_not_found)
{
    std::set<int> hidden;
    for (const std::vector<int64>& removed : {std::vector<int64>{7, 0}, {0, 1}, {3}, {6}})
    {
        index->remove(removed);
        hidden.insert(removed.begin(), removed.end());
        for (int k : {1, 70})
            EXPECT_TRUE(expected(images, queries, k, hidden) ==
                        search(*MappedIndex::open(folder.name), queries, k));
    }
    EXPECT_EQ(2163, index->rows());
    EXPECT_THROW(index->remove({8}), cv::Exception);
}

TEST_F(IIB_MappedIndex, readers_see_the_commit_that_they_opened)
{
    const Ptr<MappedIndex> reader = MappedIndex::open(folder.name);
    const Neighbours before = search(*reader, queries, 3);
    index->add(queries);
    index->remove({0});
    EXPECT_TRUE(before == search(*reader, queries, 3));
    EXPECT_NE(index->version(), reader->version());
    reader->refresh();
    EXPECT_EQ(index->version(), reader->version());
    images.push_back(queries);
    EXPECT_TRUE(expected(images, queries, 3, {0}) == search(*reader, queries, 3));
    EXPECT_EQ(std::vector<int>(queries.rows, 0), search(*reader, queries, 1).distances);
}

TEST_F(IIB_MappedIndex, mistakes)
{
    expectError(Error::StsBadArg, folder.name, [&] { MappedIndex::create(folder.name, LEVELS); });
    expectError(Error::StsError, "manifest.iib", [&] { MappedIndex::open(folder.name + "/none"); });
    expectError(Error::StsError, "parent", [&] { MappedIndex::create(folder.name + "/none/none", LEVELS); });
    EXPECT_THROW(MappedIndex::create(folder.name + "/other", {}), cv::Exception);
    EXPECT_THROW(MappedIndex::create(folder.name + "/other", {0, 3}), cv::Exception);
    EXPECT_THROW(index->add(Mat(3, 41, CV_8U)), cv::Exception);
    EXPECT_EQ(8, MappedIndex::open(folder.name)->images());
}

// Effective only where the baseline and the widest instruction set pack differently.
TEST_F(IIB_MappedIndex, other_instruction_sets_read_it)
{
    const bool before = useOptimized();
    const Neighbours wanted = expected(images, queries, 3);
    for (bool optimized : {false, true})
    {
        const TemporaryFolder other;
        setUseOptimized(optimized);
        MappedIndex::create(other.name, LEVELS)->add(images);
        setUseOptimized(!optimized);
        const Ptr<MappedIndex> opened = MappedIndex::open(other.name);
        EXPECT_TRUE(wanted == search(*opened, queries, 3));
        EXPECT_EQ(0, cvtest::norm(images[6], opened->descriptors(6), NORM_INF));
    }
    setUseOptimized(before);
}

}}  // namespace opencv_test
