// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#ifndef OPENCV_IIB_MATCHER_BLOCKED_SEARCH_HPP
#define OPENCV_IIB_MATCHER_BLOCKED_SEARCH_HPP

#include "packed_codes.hpp"

#include <functional>

namespace cv {
namespace iib {

//! Takes what a sweep finds, and says how near a pair has to be.
class BlockSink : public HammingSink
{
public:
    BlockSink() : firstQuery(0), firstTrain(0) {}
    //! The scans that follow count from here.
    void moveTo(size_t query, size_t train)
    {
        firstQuery = query;
        firstTrain = train;
    }
    virtual const int* queryBelow() const = 0;
    virtual const int* trainBelow() const = 0;

protected:
    size_t firstQuery, firstTrain;
};

//! One pass over all pairs of queries and an index's train codes, in blocks that stay in cache.
class BlockedSearch
{
public:
    BlockedSearch(const PackedCodes& index, const Mat& codes, const Mat& queries, const PruningPolicy& plan,
            const std::vector<Mat>& masks);

    //! forTrains is null when nobody asks for the other direction.
    SearchCost nearest(KnnTable& forQueries, KnnTable* forTrains) const;
    SearchCost within(int radius, std::vector<std::vector<MatchKey>>& result) const;

private:
    //! Queries `from` to `to` against all.
    SearchCost run(int from, int to, BlockSink& sink) const;
    SearchCost block(int from, int to, int group, int groups, const unsigned* plain, int* limits,
            BlockSink& sink) const;
    //! Fills the flags of existing pairs and returns their number.
    size_t allow(int from, int to, size_t firstRow, size_t count, uchar* allowed) const;
    //! Some parts for each thread, so that all are done at about the same time.
    int evenParts() const;
    //! Cuts the queries in parts for threads.
    void split(int parts, const std::function<SearchCost(int, int)>& body, SearchCost& cost) const;

    const PackedCodes& index;
    const Mat &codes, &queries;
    const PruningPolicy& plan;
    const std::vector<Mat>& masks;
};

}  // namespace iib
}  // namespace cv

#endif
