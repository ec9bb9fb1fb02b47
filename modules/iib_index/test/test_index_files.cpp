// SPDX-License-Identifier: Apache-2.0

#include "index_fixture.hpp"

#include "opencv2/iib/detail/checked_file.hpp"

namespace opencv_test { namespace {

struct IIB_MappedIndex_Files : public IndexFixture
{
    //! Expects that the folder opens, and each search throws and names the file.
    void expectRefused(const String& name, int code = Error::StsParseError) const
    {
        const Ptr<MappedIndex> opened = MappedIndex::open(folder.name);
        for (int i = 0; i < 2; i++)  // also the second time
            expectError(code, name, [&] { search(*opened, queries, 1); });
    }
};

//! The files of an index with levels of 1 and 20 bytes and three images of 1, 0 and 2 rows of goldenRow(), the first
//! one removed. Made by the library of 22 November 2026; a script changed their header to format 2 of code_segment.hpp.
struct Golden
{
    int layout;
    std::string segment, manifest;  //!< in hexadecimal; the segment up to its codes
};

const Golden GOLDENS[] = {
        {1,
                "494942434f44455302000000020000000100000014000000010000002409000003000000000000000100"
                "0000000000000000000000000000020000000000000009cbc0efef13f65ea33b068e505bac54",
                "494942534841524401000000020000000100000014000000010000000000000001000000000000000300"
                "0000000000000300000000000000a33b068e505bac54010000000000000000000000000000009557a1e0"
                "1523de37"},
        {2,
                "494942434f4445530200000002000000010000001400000002000000aa0a000003000000000000000100"
                "00000000000000000000000000000200000000000000be2a2d7761ed3ff2ab295c0af982bc67",
                "494942534841524401000000020000000100000014000000010000000000000001000000000000000300"
                "0000000000000300000000000000ab295c0af982bc6701000000000000000000000000000000dafbabe6"
                "7452393f"},
};

//! Positions at which the codes of each layout are not zero.
const std::vector<std::pair<int, std::string>> CODES[] = {
        {{0, "0b"}, {4, "70"}, {8, "d5"}, {64, "3b557a9fe5badf042f1f4469"}, {128, "b0f0b07070b0f050b070d0d0"},
                {192, "7f19be4329fe83c8ebc3082d"}, {256, "9c94acf494ac74b4acf4b46c"},
                {320, "cb752adfc56a1f247f5f6499"}, {384, "ec11365b51769bc0b6db0025"}},
        {{0, "0b70d5"}, {64, "3095fa"}, {80, "55ba1f"}, {96, "7adf44"}, {112, "9f0469"}, {128, "80e54a"},
                {144, "a50a6f"}, {160, "ca2f94"}, {176, "ef54b9"}, {192, "c4298e"}, {208, "e94eb3"},
                {224, "0e73d8"}, {240, "3398fd"}, {256, "58bd22"}, {272, "7de247"}, {288, "a2076c"},
                {304, "c72c91"}, {320, "ec51b6"}, {336, "1176db"}, {352, "369b"}, {368, "5bc025"}}};
const size_t CODES_SIZES[] = {448, 384};

Mat goldenRow(int row)
{
    Mat descriptor(1, 21, CV_8U);
    for (int i = 0; i < 21; i++)
        descriptor.at<uchar>(0, i) = (uchar)(37 * i + 101 * row + 11);
    return descriptor;
}

std::vector<Mat> goldenImages()
{
    std::vector<Mat> images = {goldenRow(0), Mat(0, 21, CV_8U), goldenRow(1)};
    images[2].push_back(goldenRow(2));
    return images;
}

std::string fromHex(const std::string& hex)
{
    std::string bytes;
    for (size_t i = 0; i < hex.size(); i += 2)
        bytes += (char)std::stoi(hex.substr(i, 2), 0, 16);
    return bytes;
}

//! A file's bytes with a little-endian number overwritten.
std::string with(std::string bytes, size_t position, uint64 value, int size = 8)
{
    for (int i = 0; i < size; i++)
        bytes[position + i] = (char)(value >> 8 * i);
    return bytes;
}

std::string codesOf(int layout)
{
    std::string codes(CODES_SIZES[layout - 1], '\0');
    for (const std::pair<int, std::string>& run : CODES[layout - 1])
        codes.replace(run.first, run.second.size() / 2, fromHex(run.second));
    return codes;
}

std::string segmentOf(const std::string& header, const std::string& codes)
{
    return header + std::string(4096 - header.size(), '\0') + codes;
}

void writeIndex(const String& folder, const std::string& segment, const std::string& manifest)
{
    writeFile(folder + "/segment-000001.iib", segment);
    writeFile(folder + "/manifest.iib", manifest);
}

TEST_F(IIB_MappedIndex_Files, are_written_as_documented)
{
    const TemporaryFolder own;
    const Ptr<MappedIndex> made = MappedIndex::create(own.name, {1, 20});
    made->add(goldenImages());
    made->remove({0});
    const std::string bytes = readFile(own.name + "/segment-000001.iib");
    ASSERT_GT(bytes.size(), 4096u);
    ASSERT_TRUE(bytes[24] == 1 || bytes[24] == 2);
    const Golden& golden = GOLDENS[bytes[24] - 1];
    EXPECT_TRUE(segmentOf(fromHex(golden.segment), codesOf(golden.layout)) == bytes);
    EXPECT_TRUE(fromHex(golden.manifest) == readFile(own.name + "/manifest.iib"));
}

TEST_F(IIB_MappedIndex_Files, names_in_any_language)
{
    const String name = folder.name + "/\xc3\xa9\xe6\xbc\xa2\xd0\xb6";  // in no code page of Windows
    for (int i = 0; i < 2; i++)
        (i == 0 ? MappedIndex::create(name, LEVELS) : MappedIndex::open(name))->add(images[0]);
    EXPECT_EQ(2, MappedIndex::open(name)->images());
    expectError(Error::StsBadArg, "already", [&] { MappedIndex::create(name, LEVELS); });
}

TEST_F(IIB_MappedIndex_Files, of_each_layout_are_read)
{
    for (const Golden& golden : GOLDENS)
    {
        SCOPED_TRACE(golden.layout);
        const TemporaryFolder own;
        const std::string bytes = segmentOf(fromHex(golden.segment), codesOf(golden.layout));
        writeIndex(own.name, bytes, fromHex(golden.manifest));
        Ptr<MappedIndex> opened = MappedIndex::open(own.name);
        EXPECT_EQ(std::vector<int>({1, 20}), opened->levelSizes());
        ASSERT_EQ(3, opened->images());
        for (int image = 0; image < 3; image++)
            EXPECT_EQ(0, cvtest::norm(goldenImages()[image], opened->descriptors(image), NORM_INF));
        const Neighbours found = search(*opened, goldenRow(2), 3);
        EXPECT_EQ(std::vector<int64>({2, 1, -1}), found.rows);
        EXPECT_EQ(std::vector<int>({0, (int)cvtest::norm(goldenRow(1), goldenRow(2), NORM_HAMMING), -1}),
                found.distances);
        opened->add(goldenRow(3));
        EXPECT_EQ(3, search(*MappedIndex::open(own.name), goldenRow(3), 1).rows[0]);

        opened.reset();  // Windows does not let mapped files be written
        writeIndex(own.name, with(bytes, 8, 1, 4), fromHex(golden.manifest));
        expectError(Error::StsParseError, "format 1", [&] { MappedIndex::open(own.name)->imageOf(0); });
    }
}

TEST_F(IIB_MappedIndex_Files, altered_files_are_named)
{
    for (int number : {1, 2, 4})
    {
        const RestoredFile file(segment(number));
        const size_t size = file.bytes.size();
        for (size_t position : {(size_t)0, (size_t)13, (size_t)60, (size_t)4000, size - 1, size - 700})
        {
            SCOPED_TRACE(format("segment %d, byte %d", number, (int)position));
            std::string altered = file.bytes;
            altered[position] ^= 4;
            file.write(altered);
            expectRefused(file.name);
        }
        for (size_t length : {(size_t)0, (size_t)40, size - 1})
        {
            file.write(file.bytes.substr(0, length));
            expectRefused(file.name);
        }
        file.write(file.bytes + "x");
        expectRefused(file.name);
        std::remove(file.name.c_str());
        expectRefused(file.name, Error::StsError);
    }
    {
        // a file of another index, of the same shape
        const TemporaryFolder other;
        MappedIndex::create(other.name, LEVELS)->add(Mat(randomDescriptors(99, 1, BYTES)));
        const RestoredFile file(segment(2));
        file.write(readFile(other.name + "/segment-000001.iib"));
        expectRefused(file.name);
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
    manifest.write(manifest.bytes + "x");
    expectError(Error::StsParseError, manifest.name, [&] { MappedIndex::open(folder.name); });
}

//! The bytes with the hash at `position` corrected for the bytes before it.
std::string sealed(const std::string& bytes, size_t position)
{
    cv::iib::Fnv1a hash;
    hash.add(bytes.data(), position);
    return with(bytes, position, hash.value());
}

// Files that no call writes, with right checksums. See index_folder.hpp and code_segment.hpp for positions.
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
    // rows in the manifest that the segment does not have
    for (const std::pair<size_t, uint64>& change : std::vector<std::pair<size_t, uint64>>{
                 {entries + 8, (uint64)1 << 39}, {entries + 16, (uint64)1 << 39}})
    {
        manifest.write(sealed(with(manifest.bytes, change.first, change.second), seal));
        expectRefused(first.name);
    }

    const size_t checkedBlocks = 8 + 4 + 4 + 3 * 4 + 4, rows = checkedBlocks + 4 + 8,
                 segmentSeal = rows + 4 * 8;
    const auto writeBoth = [&](const std::string& bytes) {
        first.write(sealed(bytes, segmentSeal));
        const std::string hash = readFile(first.name).substr(segmentSeal, 8);
        manifest.write(sealed(std::string(manifest.bytes).replace(entries + 24, 8, hash), seal));
    };
    // rows whose sum is right modulo 2^64
    writeBoth(with(with(with(first.bytes, rows, (uint64)1 << 63), rows + 8, (uint64)1 << 63), rows + 16, 57));
    expectRefused(first.name);
    for (int layout : {0, 3, 1 << 24})
    {
        writeBoth(with(first.bytes, checkedBlocks - 4, layout, 4));
        expectRefused(first.name);
    }
    // one checksum for all blocks: unusual, but valid
    writeBoth(with(first.bytes, checkedBlocks, INT_MAX, 4));
    EXPECT_TRUE(expected(images, queries, 3, {1, 5}) == search(*MappedIndex::open(folder.name), queries, 3));
}

#ifndef _WIN32  // Windows refuses to delete mapped files
// Deleting or replacing a mapped file is harmless.
TEST_F(IIB_MappedIndex_Files, mapped_segments_outlive_their_names)
{
    const Neighbours before = search(*index, queries, 3);
    std::remove(segment(1).c_str());
    ASSERT_EQ(0, std::rename(segment(2).c_str(), segment(4).c_str()));
    EXPECT_TRUE(before == search(*index, queries, 3));
}
#endif

// A C string ends at its first zero byte, so another folder would be made.
TEST_F(IIB_MappedIndex_Files, names_of_folders_are_bytes_without_a_zero)
{
    const String zero = folder.name + String("/a\0b", 4);
    expectError(Error::StsBadArg, "a zero byte", [&] { MappedIndex::create(zero, LEVELS); });
    EXPECT_FALSE(utils::fs::exists(folder.name + "/a"));
    MappedIndex::create(folder.name + "/a", LEVELS);
    expectError(Error::StsBadArg, "a zero byte", [&] { MappedIndex::open(zero); });
}

}}  // namespace opencv_test
