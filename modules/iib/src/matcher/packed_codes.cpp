// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "opencv2/iib/detail/packed_codes.hpp"

#include <numeric>

#include "../common/file_numbers.hpp"
#include "parameters.hpp"
#include "search.hpp"

namespace cv { namespace iib {

static const int CODES_PER_BLOCK = CodeLayout::CODES_PER_BLOCK;

void PackedCodes::check(const std::vector<int>& levelSizes)
{
    checkLevelSizesGiven(levelSizes);
    MatcherParameters p;
    p.levelSizes = levelSizes;
    p.thresholds.assign(p.stages(), 0.f);
    iib::check(p);
}

CodePacking PackedCodes::packing() const { return scans.packing; }

bool PackedCodes::knows(unsigned packing) { return packing == PACKING_ADDERS || packing == PACKING_TABLES; }

size_t PackedCodes::blockBytes(const std::vector<int>& levelSizes, unsigned packing)
{
    return CodeLayout(levelSizes, (CodePacking)packing).blockWords() * sizeof(unsigned);
}

PackedCodes::PackedCodes(const std::vector<int>& levelSizes)
    : scans(hammingKernels()), format(levelSizes, scans.packing), starts(1, 0), filled(0)
{
}

PackedCodes::PackedCodes(const std::vector<int>& levelSizes, InputArrayOfArrays descriptors)
    : PackedCodes(levelSizes)
{
    for (const Mat& image : imagesOf(descriptors))
        add(checkedDescriptors(image, format.bytes(), false));
}

static int blocksFor(size_t rows)
{
    const size_t blocks = (rows + CODES_PER_BLOCK - 1) / CODES_PER_BLOCK;
    CV_Assert(blocks <= INT_MAX && (uint64)rows < (uint64)1 << INDEX_BITS);
    return (int)blocks;
}

static void unpack(const CodeLayout& layout, const Mat& codes, size_t row, Mat& descriptors)
{
    AutoBuffer<unsigned> plain(layout.words());
    for (int i = 0; i < descriptors.rows; i++, row++)
    {
        layout.fetch(codes.ptr<unsigned>((int)(row / CODES_PER_BLOCK)), (int)(row % CODES_PER_BLOCK),
                plain.data());
        layout.restore(plain.data(), descriptors.ptr(i));
    }
}

static Mat repacked(const Mat& blocks, const CodeLayout& from, const CodeLayout& to)
{
    Mat result(blocks.rows, (int)to.blockWords(), CV_32S), descriptors(CODES_PER_BLOCK, from.bytes(), CV_8U);
    for (int i = 0; i < blocks.rows; i++)
    {
        unpack(from, blocks, (size_t)i * CODES_PER_BLOCK, descriptors);
        to.storeBlock(descriptors.data, descriptors.step, result.ptr<unsigned>(i));
    }
    return result;
}

PackedCodes::PackedCodes(const std::vector<int>& levelSizes, unsigned packing,
        const std::vector<size_t>& starts_, const Mat& blocks)
    : scans(hammingKernels()), format(levelSizes, scans.packing), starts(starts_), codes(blocks),
      filled(blocks.rows)
{
    CV_Assert(filled == blocksFor(rows()));
    if (packing != scans.packing)
        codes = repacked(blocks, CodeLayout(levelSizes, (CodePacking)packing), format);
}

PackedCodes::PackedCodes(const PackedCodes& other)
    : scans(other.scans), format(other.format), starts(other.starts), codes(other.stored().clone()),
      filled(other.filled)
{
}

size_t PackedCodes::imageOf(size_t row) const
{
    return std::upper_bound(starts.begin(), starts.end(), row) - starts.begin() - 1;
}

void PackedCodes::grow(int blocks)
{
    if (blocks > codes.rows)
        allocate(std::max(blocks, (int)std::min((int64)filled * 3 / 2, (int64)INT_MAX)));
    if (blocks > filled)
        codes.rowRange(filled, blocks).setTo(0);
    filled = blocks;
}

// If Mat::resize runs out of memory, the matrix claims more rows than its buffer holds.
void PackedCodes::allocate(int blocks)
{
    Mat larger(blocks, (int)format.blockWords(), CV_32S);
    if (filled > 0)
        codes.rowRange(0, filled).copyTo(larger.rowRange(0, filled));
    codes = larger;
}

void PackedCodes::reserve(size_t images, size_t rows)
{
    starts.reserve(images + 1);
    if (blocksFor(rows) > codes.rows)
        allocate(blocksFor(rows));
}

void PackedCodes::add(const Mat& descriptors)
{
    // everything that may throw comes before the first change
    if (starts.size() == starts.capacity())
        starts.reserve(2 * starts.size());
    grow(blocksFor(rows() + descriptors.rows));
    starts.push_back(rows());
    append(descriptors);
}

void PackedCodes::append(const Mat& descriptors)
{
    CV_Assert(images() > 0);
    grow(blocksFor(rows() + descriptors.rows));
    for (int i = 0; i < descriptors.rows;)
    {
        const size_t row = rows() + i;
        unsigned* const block = codes.ptr<unsigned>((int)(row / CODES_PER_BLOCK));
        const int lane = (int)(row % CODES_PER_BLOCK);
        if (lane == 0 && i + CODES_PER_BLOCK <= descriptors.rows)
        {
            format.storeBlock(descriptors.ptr(i), descriptors.step, block);
            i += CODES_PER_BLOCK;
        }
        else
            format.store(descriptors.ptr(i++), block, lane);
    }
    starts.back() += descriptors.rows;
}

Mat PackedCodes::descriptors(size_t image, size_t from, size_t to) const
{
    Mat result((int)(to - from), format.bytes(), CV_8U);
    unpack(format, codes, starts[image] + from, result);
    return result;
}

void PackedCodes::findNearest(const std::vector<int>& levelSizes, const std::vector<CodePart>& parts,
        InputArray queries_, int k, std::vector<int64>& rows, std::vector<int>& distances)
{
    const int width = std::accumulate(levelSizes.begin(), levelSizes.end(), 0);
    const Mat queries = checkedDescriptors(queries_.getMat(), width, false);
    require(k > 0, "k", k, "above 0");
    size_t count = 0;
    for (const CodePart& part : parts)
        count += part.codes->rows();
    checkPadding(k, queries.rows, count);
    KnnTable found(queries.rows, (int)std::min((size_t)k, std::max(count, (size_t)1)));
    SearchCost cost;
    for (const CodePart& part : parts)
        iib::addNearest(
                {*part.codes, queries, PruningPolicy(), {}, part.hidden, part.firstRow, ScanChunk(), cost},
                found);

    rows = forNeighbours<int64>(queries.rows, k, -1);
    distances = forNeighbours<int>(queries.rows, k, -1);
    for (size_t query = 0; query < (size_t)queries.rows; query++)
        for (int i = 0; i < found.size() && found[query][i] != NO_MATCH; i++)
        {
            rows[query * k + i] = (int64)indexOf(found[query][i]);
            distances[query * k + i] = distanceOf(found[query][i]);
        }
}

}}  // namespace cv::iib
