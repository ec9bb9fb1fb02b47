// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "../precomp.hpp"
#include "packed_codes.hpp"
#include "blocked_search.hpp"

namespace cv {
namespace iib {

static const int CODES_PER_BLOCK = CodeLayout::CODES_PER_BLOCK;

PackedCodes::PackedCodes(const std::vector<int>& levelSizes)
    : format(levelSizes, hammingPacking()), starts(1, 0)
{
}

PackedCodes::PackedCodes(const PackedCodes& other)
    : format(other.format), starts(other.starts), codes(other.codes.clone())
{
}

size_t PackedCodes::imageOf(size_t row) const
{
    return std::upper_bound(starts.begin(), starts.end(), row) - starts.begin() - 1;
}

// Not by Mat::resize: when memory lacks, it leaves the matrix larger than its memory.
void PackedCodes::grow(int groups)
{
    const int before = codes.rows;
    if (groups == before)
        return;
    Size whole;
    Point offset;
    if (before > 0)
        codes.locateROI(whole, offset);
    if (groups > whole.height)
    {
        Mat larger(std::max(groups, (int)std::min((int64)before * 3 / 2, (int64)INT_MAX)),
                format.words() * CODES_PER_BLOCK, CV_32S);
        if (before > 0)
            codes.copyTo(larger.rowRange(0, before));
        codes = larger.rowRange(0, groups);
    }
    else
        codes.adjustROI(0, groups - before, 0, 0);
    std::fill(codes.ptr<unsigned>(before),
            codes.ptr<unsigned>(before) + (size_t)(groups - before) * codes.cols, 0u);
}

void PackedCodes::add(const Mat& descriptors)
{
    const size_t end = rows() + descriptors.rows, groups = (end + CODES_PER_BLOCK - 1) / CODES_PER_BLOCK;
    CV_Assert(groups <= INT_MAX && end < (size_t)1 << INDEX_BITS);
    // Whatever needs memory comes before the first change.
    std::vector<unsigned> code(format.words());
    if (starts.size() == starts.capacity())
        starts.reserve(2 * starts.size());
    grow((int)groups);
    for (int i = 0; i < descriptors.rows; i++)
    {
        const size_t row = rows() + i;
        format.arrange(descriptors.ptr(i), code.data());
        format.store(code.data(), codes.ptr<unsigned>((int)(row / CODES_PER_BLOCK)), row % CODES_PER_BLOCK);
    }
    starts.push_back(end);
}

Mat PackedCodes::descriptors(size_t image) const
{
    Mat result((int)rows(image), format.bytes(), CV_8U);
    AutoBuffer<unsigned> plain(format.words());
    for (int i = 0; i < result.rows; i++)
    {
        const size_t row = starts[image] + i;
        format.fetch(codes.ptr<unsigned>((int)(row / CODES_PER_BLOCK)), row % CODES_PER_BLOCK, plain.data());
        format.restore(plain.data(), result.ptr(i));
    }
    return result;
}

// Leaves the pairs that are among the nearest in both directions.
static void keepMutual(KnnTable& forQueries, const KnnTable& forTrains)
{
    for (size_t query = 0; query < forQueries.rows(); query++)
    {
        MatchKey *first = forQueries[query], *last = first + forQueries.size();
        MatchKey* end = std::remove_if(first, last, [&](MatchKey n) {
            if (n == NO_MATCH)
                return true;
            const MatchKey* back = forTrains[indexOf(n)];
            return !std::binary_search(back, back + forTrains.size(), matchKey(distanceOf(n), query));
        });
        std::fill(end, last, NO_MATCH);
    }
}

static bool passesRatio(const MatchKey* row, float maxRatio)
{
    return row[1] == NO_MATCH || distanceOf(row[0]) < (double)maxRatio * distanceOf(row[1]);
}

KnnTable PackedCodes::nearest(const Mat& queries, const PruningPolicy& plan, int k, bool mutual,
        float maxRatio, const std::vector<Mat>& masks, SearchCost& cost) const
{
    // Each direction has as many neighbours as the other side has codes, at most.
    const int backK = std::min(k, std::max(queries.rows, 1));
    k = (int)std::min((size_t)k, std::max(rows(), (size_t)1));
    const bool ratio = maxRatio < 1;
    KnnTable forQueries(queries.rows, std::max(k, ratio ? 2 : 1));
    KnnTable forTrains(mutual ? rows() : 0, backK, CODES_PER_BLOCK);
    const BlockedSearch sweep(*this, codes, queries, plan, masks);
    cost = sweep.nearest(forQueries, mutual ? &forTrains : 0);

    KnnTable result(queries.rows, k);
    for (int query = 0; query < queries.rows; query++)
        if (!ratio || passesRatio(forQueries[query], maxRatio))
            std::copy(forQueries[query], forQueries[query] + k, result[query]);
    if (mutual)
        keepMutual(result, forTrains);
    return result;
}

std::vector<std::vector<MatchKey>> PackedCodes::within(const Mat& queries, const PruningPolicy& plan,
        int radius, const std::vector<Mat>& masks, SearchCost& cost) const
{
    std::vector<std::vector<MatchKey>> result(queries.rows);
    const BlockedSearch sweep(*this, codes, queries, plan, masks);
    cost = sweep.within(radius, result);
    for (size_t query = 0; query < result.size(); query++)
        std::sort(result[query].begin(), result[query].end());
    return result;
}

}  // namespace iib
}  // namespace cv
