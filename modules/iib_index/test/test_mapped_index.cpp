// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "test_precomp.hpp"

#include "../../iib/src/common/fnv1a.hpp"
#include "../../iib/test/support/disk.hpp"
#include "../../iib/test/support/random_descriptors.hpp"
#include "../../iib/test/support/temporary_file.hpp"
#include "../../iib/test/support/test_errors.hpp"

#include <thread>

#ifdef __linux__
#include <csignal>
#include <sys/wait.h>
#include <unistd.h>
#endif

namespace opencv_test {
namespace {

const std::vector<int> LEVELS = {2, 8, 32};
const int BYTES = 42;

struct Found
{
    std::vector<int64> rows;
    std::vector<int> distances;
    bool operator==(const Found& other) const { return rows == other.rows && distances == other.distances; }
};

Found search(const MappedIndex& index, const Mat& queries, int k, int segment = -1)
{
    Found found;
    index.knnSearch(queries, k, found.rows, found.distances, segment);
    return found;
}

//! What brute force finds; `hidden` images are left out.
Found expected(const std::vector<Mat>& images, const Mat& queries, int k,
        const std::set<int>& hidden = std::set<int>())
{
    Found found;
    for (int q = 0; q < queries.rows; q++)
    {
        std::vector<std::pair<int, int64>> all;
        int64 row = 0;
        for (size_t image = 0; image < images.size(); image++)
            for (int i = 0; i < images[image].rows; i++, row++)
                if (!hidden.count((int)image))
                    all.push_back(std::make_pair(
                            hammingDistance(queries.ptr(q), images[image].ptr(i), BYTES), row));
        std::sort(all.begin(), all.end());
        all.resize(k, std::make_pair(-1, (int64)-1));
        for (const std::pair<int, int64>& one : all)
        {
            found.distances.push_back(one.first);
            found.rows.push_back(one.second);
        }
    }
    return found;
}

//! A segment each: 3 images, one of them empty; a single row; nothing; more than a block of the scan.
const std::vector<std::vector<int>> ADDED = {{40, 0, 17}, {1}, {0, 0}, {2100, 5}};

//! An index of ADDED and what is in it.
struct IIB_MappedIndex : public testing::Test
{
    const TemporaryFolder folder;
    std::vector<Mat> images;
    Mat queries;
    Ptr<MappedIndex> index;

    void SetUp() CV_OVERRIDE
    {
        index = MappedIndex::create(folder.name, LEVELS);
        for (const std::vector<int>& rows : ADDED)
        {
            std::vector<Mat> added;
            for (int count : rows)
                added.push_back(randomDescriptors(images.size() + added.size(), count, BYTES));
            index->add(added);
            images.insert(images.end(), added.begin(), added.end());
        }
        queries = randomDescriptors(100, 23, BYTES);
    }
    String segment(int number) const { return folder.name + format("/segment-%06d.iib", number); }
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
    const Found before = search(*reader, queries, 3);
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

TEST_F(IIB_MappedIndex, writers_at_the_same_time_lose_nothing)
{
    std::vector<std::thread> writers;
    for (int i = 0; i < 4; i++)
        writers.push_back(std::thread([&, i] {
            const Ptr<MappedIndex> own = MappedIndex::open(folder.name);
            for (int n = 0; n < 5; n++)
                own->add(Mat(1, BYTES, CV_8U, Scalar(i * 5 + n)));
        }));
    for (std::thread& writer : writers)
        writer.join();
    index->refresh();
    ASSERT_EQ(28, index->images());
    std::set<int> values;
    for (int image = 8; image < 28; image++)
        values.insert(index->descriptors(image).at<uchar>(0, 0));
    EXPECT_EQ(20u, values.size());
}

TEST_F(IIB_MappedIndex, altered_files_are_named)
{
    for (int number : {1, 2, 4})
    {
        const RestoredFile file(segment(number));
        const size_t size = file.bytes.size();
        for (size_t position : {(size_t)0, (size_t)13, (size_t)60, size - 1, size - 700})
        {
            SCOPED_TRACE(format("segment %d, byte %d", number, (int)position));
            std::string altered = file.bytes;
            altered[position] ^= 4;
            file.write(altered);
            const Ptr<MappedIndex> opened = MappedIndex::open(folder.name);
            for (int i = 0; i < 2; i++)  // not only the first time
                expectError(Error::StsParseError, file.name, [&] { search(*opened, queries, 1); });
        }
        for (size_t length : {(size_t)0, (size_t)40, size - 1})
        {
            file.write(file.bytes.substr(0, length));
            const Ptr<MappedIndex> opened = MappedIndex::open(folder.name);
            expectError(Error::StsParseError, file.name, [&] { search(*opened, queries, 1); });
        }
        {
            file.write(file.bytes + "x");
            const Ptr<MappedIndex> opened = MappedIndex::open(folder.name);
            expectError(Error::StsParseError, file.name, [&] { search(*opened, queries, 1); });
        }
        std::remove(file.name.c_str());
        const Ptr<MappedIndex> opened = MappedIndex::open(folder.name);
        expectError(Error::StsError, file.name, [&] { search(*opened, queries, 1); });
    }
    {
        // another index's, of the same shape
        const TemporaryFolder other;
        MappedIndex::create(other.name, LEVELS)->add(Mat(randomDescriptors(99, 1, BYTES)));
        const RestoredFile file(segment(2));
        file.write(readFile(other.name + "/segment-000001.iib"));
        const Ptr<MappedIndex> opened = MappedIndex::open(folder.name);
        expectError(Error::StsParseError, file.name, [&] { search(*opened, queries, 1); });
    }
    const RestoredFile manifest(folder.name + "/manifest.iib");
    for (size_t position = 0; position < manifest.bytes.size(); position += 7)
    {
        std::string altered = manifest.bytes;
        altered[position] ^= 4;
        manifest.write(altered);
        expectError(Error::StsParseError, manifest.name, [&] { MappedIndex::open(folder.name); });
        manifest.write(manifest.bytes.substr(0, position));
        expectError(Error::StsParseError, manifest.name, [&] { MappedIndex::open(folder.name); });
    }
}

//! A file's bytes with a number put in, little-endian.
std::string with(std::string bytes, size_t position, uint64 value, int size = 8)
{
    for (int i = 0; i < size; i++)
        bytes[position + i] = (char)(value >> 8 * i);
    return bytes;
}

//! The same with the hash at `position` made that of what is before it.
std::string sealed(const std::string& bytes, size_t position)
{
    cv::iib::Fnv1a hash;
    hash.add(bytes.data(), position);
    return with(bytes, position, hash.value());
}

// Files that no call writes, all checksums right. Positions: see manifest.hpp and code_segment.hpp.
TEST_F(IIB_MappedIndex, impossible_numbers_are_refused)
{
    index->remove({1, 5});
    const RestoredFile manifest(folder.name + "/manifest.iib"), first(segment(1));
    const size_t entries = 8 + 4 + 4 + 3 * 4 + 8, removed = entries + 4 * 32 + 8, seal = removed + 2 * 8;
    ASSERT_EQ(seal + 8, manifest.bytes.size());
    const std::vector<std::pair<size_t, uint64>> impossible = {{entries, 2}, {entries + 32, 1},
            {entries + 8, (uint64)1 << 40}, {entries + 8, (uint64)0 - 57}, {entries + 16, (uint64)1 << 40},
            {entries + 16, (uint64)0 - 3}, {removed, 6}, {removed, 5}, {removed + 8, 8}};
    for (const std::pair<size_t, uint64>& change : impossible)
    {
        SCOPED_TRACE(format("byte %d, %llu", (int)change.first, (unsigned long long)change.second));
        manifest.write(sealed(with(manifest.bytes, change.first, change.second), seal));
        expectError(Error::StsParseError, manifest.name, [&] { MappedIndex::open(folder.name); });
    }
    // what the manifest claims, the segment does not have
    for (const std::pair<size_t, uint64>& change : std::vector<std::pair<size_t, uint64>>{
                 {entries + 8, (uint64)1 << 39}, {entries + 16, (uint64)1 << 39}})
    {
        manifest.write(sealed(with(manifest.bytes, change.first, change.second), seal));
        const Ptr<MappedIndex> opened = MappedIndex::open(folder.name);
        expectError(Error::StsParseError, first.name, [&] { search(*opened, queries, 1); });
    }

    const size_t checkedBlocks = 8 + 4 + 4 + 3 * 4 + 8, rows = checkedBlocks + 4 + 8,
                 segmentSeal = rows + 4 * 8;
    const auto writeBoth = [&](const std::string& bytes) {
        first.write(sealed(bytes, segmentSeal));
        const std::string hash = readFile(first.name).substr(segmentSeal, 8);
        manifest.write(sealed(std::string(manifest.bytes).replace(entries + 24, 8, hash), seal));
    };
    // rows whose sum is right beyond 64 bits
    writeBoth(with(with(with(first.bytes, rows, (uint64)1 << 63), rows + 8, (uint64)1 << 63), rows + 16, 57));
    const Ptr<MappedIndex> opened = MappedIndex::open(folder.name);
    expectError(Error::StsParseError, first.name, [&] { search(*opened, queries, 1); });
    // one checksum for all: unusual, but right
    writeBoth(with(first.bytes, checkedBlocks, INT_MAX, 4));
    EXPECT_TRUE(expected(images, queries, 3, {1, 5}) == search(*MappedIndex::open(folder.name), queries, 3));
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

// What one instruction set packed, another reads: on machines and under pins where baseline and widest pack differently.
TEST_F(IIB_MappedIndex, other_instruction_sets_read_it)
{
    const bool before = useOptimized();
    const Found wanted = expected(images, queries, 3);
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

#ifdef __linux__
TEST_F(IIB_MappedIndex, full_disk_keeps_the_last_commit)
{
    for (rlim_t bytes : {50, 3000, 5000})
    {
        const FullDisk full(bytes);
        EXPECT_THROW(index->add(randomDescriptors(50, 1000, BYTES)), cv::Exception);
    }
    {
        const FullDisk full(100);
        EXPECT_THROW(index->remove({0}), cv::Exception);
    }
    EXPECT_TRUE(expected(images, queries, 3) == search(*index, queries, 3));
    EXPECT_TRUE(expected(images, queries, 3) == search(*MappedIndex::open(folder.name), queries, 3));
    index->add(queries);
    EXPECT_EQ(9, MappedIndex::open(folder.name)->images());
}

TEST_F(IIB_MappedIndex, killed_writers_leave_whole_commits)
{
    int64 count = index->images();
    for (int delay = 0; delay < 20; delay++)
    {
        const pid_t writer = fork();
        if (writer == 0)
            for (;;)  // until it is killed
                MappedIndex::open(folder.name)->add(images[0]);
        ASSERT_GT(writer, 0);
        while (index->images() == count)  // until it has committed something
            index->refresh();
        usleep(delay * 300);
        kill(writer, SIGKILL);
        waitpid(writer, 0, 0);
        index->refresh();
        EXPECT_GT(index->images(), count);
        count = index->images();
        search(*index, queries, 1);
    }
    index->add(images[0]);
    std::vector<String> unfinished;
    cv::glob(folder.name + "/*.tmp", unfinished);
    EXPECT_TRUE(unfinished.empty());
    for (int64 image = images.size(); image < index->images(); image++)
        ASSERT_EQ(0, cvtest::norm(images[0], index->descriptors(image), NORM_INF));
}
#endif

}  // namespace
}  // namespace opencv_test
