// SPDX-License-Identifier: Apache-2.0
#include "perf_precomp.hpp"

namespace opencv_test { namespace {
using cv::iib::MappedIndex;

//! An index of a million random codes of 64 bytes, searched on one thread.
struct MillionCodes
{
    const std::string folder = tempfile(".codes");
    Mat queries = Mat(10, 64, CV_8U);
    std::vector<int64> rows;
    std::vector<int> distances;

    MillionCodes()
    {
        Mat codes(1000000, queries.cols, CV_8U);
        randu(codes, 0, 256);
        randu(queries, 0, 256);
        MappedIndex::create(folder, std::vector<int>(1, queries.cols))->add(codes);
        setNumThreads(1);
    }
    ~MillionCodes()
    {
        setNumThreads(-1);
        utils::fs::remove_all(folder);
    }
};

PERF_TEST(IIB_MappedIndex, open_and_first_search)  // maps and checks all codes
{
    MillionCodes found;
    TEST_CYCLE()
    MappedIndex::open(found.folder)->knnSearch(found.queries.row(0), 1, found.rows, found.distances);
    SANITY_CHECK_NOTHING();
}

PERF_TEST(IIB_MappedIndex, ten_among_a_million)
{
    MillionCodes found;
    const Ptr<MappedIndex> index = MappedIndex::open(found.folder);
    index->knnSearch(found.queries, 5, found.rows, found.distances);
    TEST_CYCLE() index->knnSearch(found.queries, 5, found.rows, found.distances);
    SANITY_CHECK_NOTHING();
}

}}  // namespace opencv_test

CV_PERF_TEST_MAIN(iib_index)
