// SPDX-License-Identifier: Apache-2.0

#include "precomp.hpp"
#include "code_segment.hpp"
#include "opencv2/iib/detail/checked_file.hpp"

namespace cv { namespace iib {

static const FileKind KIND = {"IIBCODES", 2, "a segment of MappedIndex"};
static const size_t ALIGNMENT = 4096;
static const size_t CHECKED_BYTES = 1 << 20;

static uint64 aligned(uint64 offset) { return (offset + ALIGNMENT - 1) / ALIGNMENT * ALIGNMENT; }

// FNV-1a of little-endian 64-bit words, eight times as fast as of bytes. Each step is injective, so a single changed
// word is always detected.
static uint64 wordHash(const Mat& blocks)
{
    uint64 state = CV_BIG_UINT(0xcbf29ce484222325);
    for (const uchar *p = blocks.data, *end = p + blocks.rows * blocks.step; p < end; p += 8)
    {
        const uint64 word = (uint64)p[0] | (uint64)p[1] << 8 | (uint64)p[2] << 16 | (uint64)p[3] << 24 |
                            (uint64)p[4] << 32 | (uint64)p[5] << 40 | (uint64)p[6] << 48 | (uint64)p[7] << 56;
        state = (state ^ word) * CV_BIG_UINT(0x100000001b3);
    }
    return state;
}

// Calls `visit` in parallel with the number and the blocks of each part that has a checksum.
template <typename Visit> static void forEachPart(const Mat& blocks, int checkedBlocks, const Visit& visit)
{
    const int parts = (int)(((int64)blocks.rows + checkedBlocks - 1) / checkedBlocks);
    parallel_for_(Range(0, parts), [&](const Range& range) {
        for (int i = range.start; i < range.end; i++)
        {
            const int first = i * checkedBlocks, count = std::min(checkedBlocks, blocks.rows - first);
            visit(i, blocks.rowRange(first, first + count));
        }
    });
}

SegmentEntry writeSegment(
        const String& filename, uint64 number, const std::vector<int>& levels, const PackedCodes& codes)
{
    const Mat blocks = codes.stored();
    const size_t blockBytes = PackedCodes::blockBytes(levels, codes.packing());
    const int checkedBlocks = (int)std::max(CHECKED_BYTES / blockBytes, (size_t)1);
    std::vector<uint64> sums((size_t)(((int64)blocks.rows + checkedBlocks - 1) / checkedBlocks));
    forEachPart(blocks, checkedBlocks, [&](int i, const Mat& part) { sums[i] = wordHash(part); });
    CheckedWriter file(filename, KIND);
    file.list(levels, 4);
    file.number(codes.packing(), 4);
    file.number(checkedBlocks, 4);
    file.number(codes.images(), 8);
    for (size_t i = 0; i < codes.images(); i++)
        file.number(codes.rows(i), 8);
    for (uint64 sum : sums)
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
    std::vector<uchar> intact(checksums.size());
    forEachPart(mapped, checkedBlocks,
            [&](int i, const Mat& part) { intact[i] = wordHash(part) == checksums[i]; });
    const size_t wrong = std::find(intact.begin(), intact.end(), 0) - intact.begin();
    if (wrong < intact.size())
        header.fail(format("it is altered: the checksum of its rows from %lld on is wrong",
                (long long)(wrong * partRows)));
    packed = makePtr<PackedCodes>(levels, layout, starts, mapped);
    file = bytes;
}

}}  // namespace cv::iib
