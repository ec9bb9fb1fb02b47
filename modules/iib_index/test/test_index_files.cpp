// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "index_fixture.hpp"

#include "../../iib/src/common/fnv1a.hpp"

namespace opencv_test {
namespace {

struct IIB_MappedIndex_Files : public IndexFixture
{
};

TEST_F(IIB_MappedIndex_Files, altered_files_are_named)
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
TEST_F(IIB_MappedIndex_Files, impossible_numbers_are_refused)
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

}  // namespace
}  // namespace opencv_test
