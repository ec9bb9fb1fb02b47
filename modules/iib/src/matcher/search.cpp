// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "search.hpp"

#include <mutex>

namespace cv { namespace iib {

namespace {

//! Calls scan(Range of queries) for parts of the queries, in parallel.
template <class Scan> void scanInParts(int queries, int parts, const Scan& scan)
{
    const int size =
            std::max((queries + parts - 1) / parts, 4);  // kernels compare up to 4 queries or more at a time
    const int count = (queries + size - 1) / size;
    const auto scanSome = [&](const Range& some) {
        scan(Range(some.start * size, std::min(some.end * size, queries)));
    };
    parallel_for_(Range(0, count), scanSome, count);
}

// At least two parts for each thread, so that threads end at about the same time.
int evenParts(const SearchInput& input)
{
    const int chunks = (input.queries.rows + input.chunk.queryCount - 1) / input.chunk.queryCount,
              threads = getNumThreads();
    return std::max((chunks + threads - 1) / threads, 2) * threads;
}

// Each part has a table of its own for train codes. They are merged by keys, so the order of parts does not matter. Parts are
// few, since each begins without thresholds.
void addNearestOfBoth(const SearchInput& input, KnnTable& forQueries, KnnTable& forTrains)
{
    std::mutex lock;
    scanInParts(input.queries.rows, getNumThreads(), [&](const Range& queries) {
        KnnTable own(forTrains.rows(), forTrains.size(), CodeLayout::CODES_PER_BLOCK);
        scanNearest(input, queries, forQueries, &own);
        std::lock_guard<std::mutex> guard(lock);
        forTrains.merge(own);
    });
}

void keepMutual(KnnTable& forQueries, const KnnTable& forTrains)
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

// The decimal number behind a float such as .6f differs by up to FLT_EPSILON from it: ties at the decimal number fail.
bool passesRatio(const MatchKey* row, float maxRatio)
{
    return row[1] == NO_MATCH || distanceOf(row[0]) < maxRatio * (1. - FLT_EPSILON) * distanceOf(row[1]);
}

// Rows that fail the ratio test become empty.
KnnTable afterRatio(const KnnTable& found, int k, float maxRatio)
{
    KnnTable result(found.rows(), k);
    for (size_t query = 0; query < found.rows(); query++)
        if (passesRatio(found[query], maxRatio))
            std::copy(found[query], found[query] + k, result[query]);
    return result;
}

//! The standard deviation of the distance between random codes of n bits.
double spread(int bits) { return std::sqrt((double)bits) / 2; }

}  // namespace

std::vector<Mat> checkedMasks(InputArrayOfArrays masks_, int queries, const PackedCodes& index)
{
    std::vector<Mat> masks;
    masks_.getMatVector(masks);
    if (!masks.empty() && masks.size() != index.images())
        CV_Error_(Error::StsBadSize,
                ("%d masks for %d train images: give one for each, empty for \"all allowed\"",
                        (int)masks.size(), (int)index.images()));
    bool any = false;
    for (size_t i = 0; i < masks.size(); i++)
    {
        any = any || !masks[i].empty();
        if (!masks[i].empty() && (masks[i].type() != CV_8UC1 || masks[i].rows != queries ||
                                         (size_t)masks[i].cols != index.rows(i)))
            CV_Error_(Error::StsBadMask,
                    ("masks[%d] must be CV_8UC1 with %d rows (queries) and %d columns (train "
                     "rows)",
                            (int)i, queries, (int)index.rows(i)));
    }
    return any ? masks : std::vector<Mat>();
}

// One stage, as soon as most random pairs are beyond the radius; none if that is late.
PruningPolicy radiusPolicy(const CodeLayout& layout, int radius)
{
    PruningPolicy policy;
    policy.limit = radius;
    for (int words = 1; words * 8 <= layout.words() * 7 && policy.stages.empty(); words += 2)
        if (radius < layout.bits(words) / 2 - 5 * spread(layout.bits(words)))
            policy.stages.push_back({words, PruneStage::NO_MAX});
    return policy;
}

// As in passesRatio(), but ties at the decimal number pass.
PruningPolicy thresholdPolicy(const CodeLayout& layout, const std::vector<float>& thresholds)
{
    PruningPolicy policy;
    for (int level = 0; level + 1 < layout.levels(); level++)
        policy.stages.push_back({layout.end(level),
                cvFloor(thresholds[level] * (1. + FLT_EPSILON) * 8 * layout.levelSizes()[level])});
    return policy;
}

PruningPolicy adaptivePolicy(const CodeLayout& layout)
{
    PruningPolicy policy;
    if (layout.segments() < 2)
        return policy;
    policy.stages.push_back({layout.end(layout.segments() - 2), PruneStage::NO_MAX});
    policy.margin = cvRound(1.75 * spread(layout.bits(policy.stages[0].words)));
    return policy;
}

void addNearest(const SearchInput& input, KnnTable& forQueries)
{
    scanInParts(input.queries.rows, evenParts(input),
            [&](const Range& queries) { scanNearest(input, queries, forQueries, 0); });
}

KnnTable findNearest(const SearchInput& input, int k, bool mutual, float maxRatio)
{
    const size_t trains = input.trains.rows();
    const int queries = input.queries.rows, backK = std::min(k, std::max(queries, 1));
    k = (int)std::min((size_t)k, std::max(trains, (size_t)1));
    const bool ratio = maxRatio < 1;
    KnnTable forQueries(queries, std::max(k, ratio ? 2 : 1));
    KnnTable forTrains(mutual ? trains : 0, backK);
    mutual ? addNearestOfBoth(input, forQueries, forTrains) : addNearest(input, forQueries);
    if (ratio)
        forQueries = afterRatio(forQueries, k, maxRatio);
    if (mutual)
        keepMutual(forQueries, forTrains);
    return forQueries;
}

void checkPadding(int k, size_t queries, size_t rows)
{
    const uint64 most = 1 << 26;  // neighbours, 12 bytes each
    if ((size_t)std::max(k, 0) > rows && (uint64)queries * k > most)
        CV_Error_(Error::StsOutOfRange, ("k is %d, but there are %llu descriptors to find: ask for at most "
                                         "%llu for each of %llu queries",
                                                k, (unsigned long long)rows,
                                                (unsigned long long)std::max((uint64)rows, most / queries),
                                                (unsigned long long)queries));
}

std::vector<std::vector<MatchKey>> findWithin(const SearchInput& input, int radius)
{
    std::vector<std::vector<MatchKey>> result(input.queries.rows);
    scanInParts(input.queries.rows, evenParts(input),
            [&](const Range& queries) { scanWithin(input, queries, radius, result); });
    for (size_t query = 0; query < result.size(); query++)
        std::sort(result[query].begin(), result[query].end());
    return result;
}

}}  // namespace cv::iib
