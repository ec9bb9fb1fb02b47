// SPDX-License-Identifier: Apache-2.0

#include "precomp.hpp"
#include "code_segment.hpp"
#include "opencv2/iib/detail/checked_file.hpp"

#include <cstring>

namespace cv { namespace iib {

static const FileKind KIND = {"IIBCODES", 2, "a segment of MappedIndex"};
static const size_t ALIGNMENT = 4096;
static const size_t CHECKED_BYTES = 1 << 20;

static uint64 aligned(uint64 offset) { return (offset + ALIGNMENT - 1) / ALIGNMENT * ALIGNMENT; }

// FNV-1a of little-endian 64-bit words, eight times as fast as of bytes. Each step is injective, so a single changed
// word is always detected.
static uint64 wordHash(const Mat& blocks)
{
    uint64 state = CV_BIG_UINT(0xcbf29ce484222325), word;
    for (const uchar *p = blocks.data, *end = p + blocks.rows * blocks.step; p < end; p += sizeof(word))
    {
        std::memcpy(&word, p, sizeof(word));  // all supported machines are little-endian
        state = (state ^ word) * CV_BIG_UINT(0x100000001b3);
    }
    return state;
}

// The checksums of parts of some blocks each, computed in parallel.
static std::vector<uint64> checksumsOf(const Mat& blocks, int checkedBlocks)
{
    std::vector<uint64> sums((size_t)(((int64)blocks.rows + checkedBlocks - 1) / checkedBlocks));
    parallel_for_(Range(0, (int)sums.size()), [&](const Range& range) {
        for (int i = range.start; i < range.end; i++)
        {
            const int first = i * checkedBlocks, count = std::min(checkedBlocks, blocks.rows - first);
            sums[i] = wordHash(blocks.rowRange(first, first + count));
        }
    });
    return sums;
}

SegmentEntry writeSegment(
        const String& filename, uint64 number, const std::vector<int>& levels, const PackedCodes& codes)
{
    const Mat blocks = codes.stored();
    const size_t blockBytes = PackedCodes::blockBytes(levels, codes.packing());
    const int checkedBlocks = (int)std::max(CHECKED_BYTES / blockBytes, (size_t)1);
    CheckedWriter file(filename, KIND);
    file.list(levels, 4);
    file.number(codes.packing(), 4);
    file.number(checkedBlocks, 4);
    file.number(codes.images(), 8);
    for (size_t i = 0; i < codes.images(); i++)
        file.number(codes.rows(i), 8);
    for (uint64 sum : checksumsOf(blocks, checkedBlocks))
        file.number(sum, 8);
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

const PackedCodes& CodeSegment::codes()
{
    std::lock_guard<std::mutex> guard(lock);
    if (!packed)
        map();
    return *packed;
}

void CodeSegment::map()
{
    CheckedReader header(name, KIND);
    if (header.version() == 1)
        header.fail("it has format 1, which no release wrote: make the index again");
    if (header.list<int>(4) != levels)
        header.fail("its levels are not those of the manifest");
    const unsigned layout = header.word();
    if (!PackedCodes::knows(layout))
        header.fail("its layout is unknown");
    const int checkedBlocks = (int)header.word();
    std::vector<size_t> starts(1, 0);
    for (uint64 rows : header.list<uint64>(8))
    {
        if (rows > expected.rows - starts.back())
            header.fail("it is not the one that the manifest names");
        starts.push_back(starts.back() + (size_t)rows);
    }
    if (starts.size() - 1 != expected.images || starts.back() != expected.rows || checkedBlocks <= 0)
        header.fail("it is not the one that the manifest names");
    const uint64 blocks = (expected.rows + CodeLayout::CODES_PER_BLOCK - 1) / CodeLayout::CODES_PER_BLOCK;
    const uint64 sums = (blocks + checkedBlocks - 1) / checkedBlocks;
    header.expect(sums, 8);
    std::vector<uint64> checksums((size_t)sums);
    for (uint64& sum : checksums)
        sum = header.number(8);
    if (header.seal() != expected.checksum)
        header.fail("it is not the one that the manifest names");

    const uint64 offset = aligned(header.position());
    const Ptr<MappedFile> bytes = makePtr<MappedFile>(name);
    const size_t blockBytes = PackedCodes::blockBytes(levels, layout);
    if (blocks > INT_MAX || bytes->size() != offset + blocks * blockBytes)
        header.fail("it is truncated or altered");
    const Mat mapped(
            (int)blocks, (int)(blockBytes / sizeof(int)), CV_32S, const_cast<uchar*>(bytes->data()) + offset);
    if (std::count(bytes->data() + header.position(), bytes->data() + offset, 0) !=
            (int64)(offset - header.position()))
        header.fail("it is altered: the padding between its header and its codes is not zero");
    const size_t partRows = (size_t)checkedBlocks * CodeLayout::CODES_PER_BLOCK;
    const std::vector<uint64> actual = checksumsOf(mapped, checkedBlocks);
    const size_t wrong =
            std::mismatch(actual.begin(), actual.end(), checksums.begin()).first - actual.begin();
    if (wrong < actual.size())
        header.fail(format("it is altered: the checksum of its rows from %lld on is wrong",
                (long long)(wrong * partRows)));
    packed = makePtr<PackedCodes>(levels, layout, starts, mapped);
    file = bytes;
}

}}  // namespace cv::iib
