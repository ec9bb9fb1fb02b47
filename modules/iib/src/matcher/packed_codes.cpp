// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "../precomp.hpp"
#include "packed_codes.hpp"
#include "index_bits.hpp"

namespace cv {
namespace iib {

static const int CODES_PER_BLOCK = CodeLayout::CODES_PER_BLOCK;

PackedCodes::PackedCodes(const std::vector<int>& levelSizes)
    : scans(hammingKernels()), packing(scans.packing), format(levelSizes, packing), lying(format),
      starts(1, 0), filled(0)
{
}

static int blocksFor(size_t rows)
{
    const size_t blocks = (rows + CODES_PER_BLOCK - 1) / CODES_PER_BLOCK;
    CV_Assert(blocks <= INT_MAX && rows < (size_t)1 << INDEX_BITS);
    return (int)blocks;
}

PackedCodes::PackedCodes(const std::vector<int>& levelSizes, CodePacking packing_,
        const std::vector<size_t>& starts_, const unsigned* blocks)
    : scans(hammingKernels()), packing(packing_), format(levelSizes, scans.packing),
      lying(levelSizes, packing), starts(starts_),
      codes(blocksFor(starts.back()), (int)lying.blockWords(), CV_32S, const_cast<unsigned*>(blocks)),
      filled(codes.rows)
{
}

PackedCodes::PackedCodes(const PackedCodes& other)
    : scans(other.scans), packing(other.packing), format(other.format), lying(other.lying),
      starts(other.starts), codes(other.codes.rowRange(0, other.filled).clone()), filled(other.filled)
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

// Not by Mat::resize: when memory lacks, it leaves the matrix larger than its memory.
void PackedCodes::allocate(int blocks)
{
    Mat larger(blocks, (int)lying.blockWords(), CV_32S);
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
    // Whatever needs memory comes before the first change.
    if (starts.size() == starts.capacity())
        starts.reserve(2 * starts.size());
    grow(blocksFor(rows() + descriptors.rows));
    starts.push_back(rows());
    store(descriptors);
}

void PackedCodes::append(const Mat& descriptors)
{
    CV_Assert(images() > 0);
    grow(blocksFor(rows() + descriptors.rows));
    store(descriptors);
}

void PackedCodes::store(const Mat& descriptors)
{
    for (int i = 0; i < descriptors.rows;)
    {
        const size_t row = rows() + i;
        unsigned* const block = codes.ptr<unsigned>((int)(row / CODES_PER_BLOCK));
        const int lane = (int)(row % CODES_PER_BLOCK);
        if (lane == 0 && i + CODES_PER_BLOCK <= descriptors.rows)
        {
            lying.storeBlock(descriptors.ptr(i), descriptors.step, block);
            i += CODES_PER_BLOCK;
        }
        else
            lying.store(descriptors.ptr(i++), block, lane);
    }
    starts.back() += descriptors.rows;
}

Mat PackedCodes::descriptors(size_t image, size_t from, size_t to) const
{
    Mat result((int)(to - from), lying.bytes(), CV_8U);
    unpack(starts[image] + from, result);
    return result;
}

void PackedCodes::unpack(size_t row, Mat& descriptors) const
{
    AutoBuffer<unsigned> plain(lying.words());
    for (int i = 0; i < descriptors.rows; i++, row++)
    {
        lying.fetch(codes.ptr<unsigned>((int)(row / CODES_PER_BLOCK)), (int)(row % CODES_PER_BLOCK),
                plain.data());
        lying.restore(plain.data(), descriptors.ptr(i));
    }
}

const unsigned* PackedCodes::block(int first, int count, Mat& scratch) const
{
    if (packing == scans.packing)
        return codes.ptr<unsigned>(first);
    scratch.create(count, (int)format.blockWords(), CV_32S);
    Mat descriptors(CODES_PER_BLOCK, format.bytes(), CV_8U);
    for (int i = 0; i < count; i++)
    {
        unpack((size_t)(first + i) * CODES_PER_BLOCK, descriptors);
        format.storeBlock(descriptors.data, descriptors.step, scratch.ptr<unsigned>(i));
    }
    return scratch.ptr<unsigned>();
}

}  // namespace iib
}  // namespace cv
