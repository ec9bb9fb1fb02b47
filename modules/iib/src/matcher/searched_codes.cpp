// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "../precomp.hpp"
#include "arguments.hpp"
#include "opencv2/iib/searched_codes.private.hpp"
#include "parameters.hpp"
#include "search.hpp"

#include <numeric>

namespace cv {
namespace iib {

static_assert((int)SearchedCodes::CODES_PER_BLOCK == (int)CodeLayout::CODES_PER_BLOCK, "one number");
static_assert((int)SearchedCodes::ROW_BITS == INDEX_BITS, "one number");

void SearchedCodes::check(const std::vector<int>& levelSizes)
{
    checkLevelSizesGiven(levelSizes);
    MatcherParameters p;
    p.levelSizes = levelSizes;
    p.thresholds.assign(p.stages(), 0.f);
    iib::check(p);
}

bool SearchedCodes::knows(unsigned layout) { return layout == PACKING_ADDERS || layout == PACKING_TABLES; }

size_t SearchedCodes::blockBytes(const std::vector<int>& levelSizes, unsigned layout)
{
    return CodeLayout(levelSizes, (CodePacking)layout).blockWords() * sizeof(unsigned);
}

bool SearchedCodes::fillsWithZeros(
        const std::vector<int>& levelSizes, unsigned layout, size_t rows, const Mat& blocks)
{
    const CodeLayout codes(levelSizes, (CodePacking)layout);
    for (int i = 0; i < blocks.rows; i++)
    {
        const size_t left = rows - (size_t)i * CODES_PER_BLOCK;
        if (!codes.fillsWithZeros(blocks.ptr<unsigned>(i), (int)std::min(left, (size_t)CODES_PER_BLOCK)))
            return false;
    }
    return true;
}

SearchedCodes::SearchedCodes(const std::vector<int>& levelSizes, InputArrayOfArrays descriptors)
    : packed(makePtr<PackedCodes>(levelSizes))
{
    const std::vector<Mat> images = imagesOf(descriptors);
    for (size_t i = 0; i < images.size(); i++)
        packed->add(checkedDescriptors(images[i], packed->layout().bytes(), false));
}

SearchedCodes::SearchedCodes(const std::vector<int>& levelSizes, unsigned layout,
        const std::vector<size_t>& starts, const Mat& blocks)
    : packed(makePtr<PackedCodes>(levelSizes, (CodePacking)layout, starts, blocks))
{
}

unsigned SearchedCodes::layout() const { return packed->kernels().packing; }

Mat SearchedCodes::blocks() const
{
    return packed->blocks() > 0 ? packed->stored() : Mat(0, (int)packed->layout().blockWords(), CV_32S);
}

size_t SearchedCodes::images() const { return packed->images(); }
size_t SearchedCodes::rows() const { return packed->rows(); }
size_t SearchedCodes::rows(size_t image) const { return packed->rows(image); }
size_t SearchedCodes::start(size_t image) const { return packed->start(image); }
size_t SearchedCodes::imageOf(size_t row) const { return packed->imageOf(row); }
Mat SearchedCodes::descriptors(size_t image) const
{
    return packed->descriptors(image, 0, packed->rows(image));
}

void SearchedCodes::findNearest(const std::vector<int>& levelSizes, const std::vector<Part>& parts,
        InputArray queries_, int k, std::vector<int64>& rows, std::vector<int>& distances)
{
    const int width = std::accumulate(levelSizes.begin(), levelSizes.end(), 0);
    const Mat queries = checkedDescriptors(queries_.getMat(), width, false);
    if (k <= 0)
        CV_Error_(Error::StsOutOfRange, ("k is %d: it has to be > 0", k));
    size_t count = 0;
    for (const Part& part : parts)
        count += part.codes->rows();
    KnnTable found(queries.rows, (int)std::min((size_t)k, std::max(count, (size_t)1)));
    SearchCost cost;
    for (const Part& part : parts)
        addNearest({*part.codes->packed, queries, PruningPolicy(), {}, part.hidden, part.firstRow,
                           ScanBlocks(), cost},
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

}  // namespace iib
}  // namespace cv
