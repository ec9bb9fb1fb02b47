// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "../precomp.hpp"
#include "search.hpp"
#include "blocked_search.hpp"

namespace cv {
namespace iib {

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

// The first k of each row that passes the ratio test; the others stay empty.
static KnnTable afterRatio(const KnnTable& found, int k, float maxRatio)
{
    KnnTable result(found.rows(), k);
    for (size_t query = 0; query < found.rows(); query++)
        if (passesRatio(found[query], maxRatio))
            std::copy(found[query], found[query] + k, result[query]);
    return result;
}

KnnTable findNearest(const SearchInput& input, int k, bool mutual, float maxRatio, SearchCost& cost)
{
    // Each direction has as many neighbours as the other side has codes, at most.
    const size_t trains = input.trains.rows();
    const int queries = input.queries.rows, backK = std::min(k, std::max(queries, 1));
    k = (int)std::min((size_t)k, std::max(trains, (size_t)1));
    const bool ratio = maxRatio < 1;
    KnnTable forQueries(queries, std::max(k, ratio ? 2 : 1));
    KnnTable forTrains(mutual ? trains : 0, backK);
    cost += searchNearest(input, forQueries, mutual ? &forTrains : 0);
    if (ratio)
        forQueries = afterRatio(forQueries, k, maxRatio);
    if (mutual)
        keepMutual(forQueries, forTrains);
    return forQueries;
}

std::vector<std::vector<MatchKey>> findWithin(const SearchInput& input, int radius, SearchCost& cost)
{
    std::vector<std::vector<MatchKey>> result(input.queries.rows);
    cost += searchWithin(input, radius, result);
    for (size_t query = 0; query < result.size(); query++)
        std::sort(result[query].begin(), result[query].end());
    return result;
}

}  // namespace iib
}  // namespace cv
