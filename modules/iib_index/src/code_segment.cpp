// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "precomp.hpp"
#include "code_segment.hpp"
#include "opencv2/iib/checked_file.private.hpp"

#include <cstring>

namespace cv {
namespace iib {

static const FileKind KIND = {"IIBCODES", 1, "a segment of MappedIndex"};
static const size_t ALIGNMENT = 4096;
static const size_t CHECKED_BYTES = 1 << 20;
static const size_t LETTERS = 8;
static const char* const LAYOUT_LETTERS[] = {"ADDERS  ", "TABLES  "};  // of layouts 1 and 2

static uint64 aligned(uint64 offset) { return (offset + ALIGNMENT - 1) / ALIGNMENT * ALIGNMENT; }

// FNV-1a of 64-bit words, which is eight times as fast as that of bytes. Each step is one to one, so that a single word
// that changed is always seen.
static uint64 wordHash(const void* data, size_t bytes)
{
    uint64 state = CV_BIG_UINT(0xcbf29ce484222325);
    for (size_t i = 0; i < bytes / sizeof(uint64); i++)
    {
        uint64 word;
        std::memcpy(&word, static_cast<const uchar*>(data) + i * sizeof(word), sizeof(word));
        state = (state ^ word) * CV_BIG_UINT(0x100000001b3);
    }
    return state;
}

// Of each `checkedBlocks` rows of a matrix with a row a block.
static std::vector<uint64> checksumsOf(const Mat& blocks, int checkedBlocks)
{
    std::vector<uint64> sums((size_t)(((int64)blocks.rows + checkedBlocks - 1) / checkedBlocks));
    parallel_for_(Range(0, (int)sums.size()), [&](const Range& range) {
        for (int i = range.start; i < range.end; i++)
            sums[i] = wordHash(blocks.ptr(i * checkedBlocks),
                    std::min(checkedBlocks, blocks.rows - i * checkedBlocks) * blocks.step);
    });
    return sums;
}

SegmentEntry writeSegment(
        const String& filename, uint64 number, const std::vector<int>& levels, const SearchedCodes& codes)
{
    const Mat blocks = codes.blocks();
    const size_t blockBytes = SearchedCodes::blockBytes(levels, codes.layout());
    const int checkedBlocks = (int)std::max(CHECKED_BYTES / blockBytes, (size_t)1);
    const std::vector<uint64> sums = checksumsOf(blocks, checkedBlocks);
    CheckedWriter file(filename, KIND);
    file.number(levels.size(), 4);
    for (size_t i = 0; i < levels.size(); i++)
        file.number(levels[i], 4);
    file.bytes(LAYOUT_LETTERS[codes.layout() - 1], LETTERS);
    file.number(checkedBlocks, 4);
    file.number(codes.images(), 8);
    for (size_t i = 0; i < codes.images(); i++)
        file.number(codes.rows(i), 8);
    for (size_t i = 0; i < sums.size(); i++)
        file.number(sums[i], 8);
    const SegmentEntry entry = {number, codes.rows(), codes.images(), file.seal()};
    const std::vector<uchar> zeros((size_t)(aligned(file.size()) - file.size()), 0);
    file.unchecked(zeros.data(), zeros.size());
    file.unchecked(blocks.data, blocks.rows * blockBytes);
    file.commit();
    return entry;
}

CodeSegment::CodeSegment(
        const String& filename, const SegmentEntry& entry, const std::vector<int>& levelSizes)
    : name(filename), expected(entry), levels(levelSizes)
{
}

const SearchedCodes& CodeSegment::codes()
{
    std::lock_guard<std::mutex> guard(lock);
    if (!packed)
        map();
    return *packed;
}

static unsigned readLayout(CheckedReader& header)
{
    char letters[LETTERS];
    header.bytes(letters, LETTERS);
    for (unsigned layout : {1, 2})
        if (std::memcmp(letters, LAYOUT_LETTERS[layout - 1], LETTERS) == 0)
            return layout;
    header.fail("its packing is unknown: it is altered");
    return 0;
}

void CodeSegment::map()
{
    CheckedReader header(name, KIND);
    bool fits = header.word() == levels.size();
    for (size_t i = 0; fits && i < levels.size(); i++)
        fits = (int)header.word() == levels[i];
    if (!fits)
        header.fail("its levels are not those of the manifest");
    const unsigned layout = readLayout(header);
    const int checkedBlocks = (int)header.word();
    const uint64 images = header.number(8);
    header.expect(images, 8);
    std::vector<size_t> starts(1, 0);
    for (uint64 i = 0; i < images; i++)
    {
        const uint64 rows = header.number(8);
        if (rows > expected.rows - starts.back())
            header.fail("it is not the one that the manifest names");
        starts.push_back(starts.back() + (size_t)rows);
    }
    if (images != expected.images || starts.back() != expected.rows || checkedBlocks <= 0)
        header.fail("it is not the one that the manifest names");
    const uint64 blocks =
            (expected.rows + SearchedCodes::CODES_PER_BLOCK - 1) / SearchedCodes::CODES_PER_BLOCK;
    const uint64 sums = (blocks + checkedBlocks - 1) / checkedBlocks;
    header.expect(sums, 8);
    std::vector<uint64> checksums((size_t)sums);
    for (size_t i = 0; i < checksums.size(); i++)
        checksums[i] = header.number(8);
    if (header.seal() != expected.checksum)
        header.fail("it is not the one that the manifest names");

    const uint64 offset = aligned(header.position());
    const Ptr<MappedFile> bytes = makePtr<MappedFile>(name);
    const size_t blockBytes = SearchedCodes::blockBytes(levels, layout);
    if (blocks > INT_MAX || bytes->size() != offset + blocks * blockBytes)
        header.fail("it is truncated or altered");
    const Mat lying(
            (int)blocks, (int)(blockBytes / sizeof(int)), CV_32S, const_cast<uchar*>(bytes->data()) + offset);
    const std::vector<uint64> found = checksumsOf(lying, checkedBlocks);
    const size_t wrong = std::mismatch(found.begin(), found.end(), checksums.begin()).first - found.begin();
    if (wrong < found.size())
        header.fail(format("it is altered: its rows from %lld on do not fit their checksum",
                (long long)wrong * checkedBlocks * SearchedCodes::CODES_PER_BLOCK));
    packed = makePtr<SearchedCodes>(levels, layout, starts, lying);
    file = bytes;
}

}  // namespace iib
}  // namespace cv
