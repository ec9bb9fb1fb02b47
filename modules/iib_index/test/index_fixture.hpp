// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "test_precomp.hpp"

#include "../../iib/test/support/random_descriptors.hpp"
#include "../../iib/test/support/temporary_file.hpp"
#include "../../iib/test/support/test_errors.hpp"

namespace opencv_test {

const std::vector<int> LEVELS = {2, 8, 32};
const int BYTES = 42;

struct Neighbours
{
    std::vector<int64> rows;
    std::vector<int> distances;
    bool operator==(const Neighbours& other) const
    {
        return rows == other.rows && distances == other.distances;
    }
};

inline Neighbours search(const MappedIndex& index, const Mat& queries, int k, int segment = -1)
{
    Neighbours found;
    index.knnSearch(queries, k, found.rows, found.distances, segment);
    return found;
}

//! The neighbours by brute force, without `hidden` images.
inline Neighbours expected(const std::vector<Mat>& images, const Mat& queries, int k,
        const std::set<int>& hidden = std::set<int>())
{
    Neighbours found;
    for (int q = 0; q < queries.rows; q++)
    {
        std::vector<std::pair<int, int64>> all;
        int64 row = 0;
        for (size_t image = 0; image < images.size(); image++)
            for (int i = 0; i < images[image].rows; i++, row++)
                if (!hidden.count((int)image))
                    all.push_back(std::make_pair(
                            hammingDistance(queries.ptr(q), images[image].ptr(i), BYTES), row));
        std::sort(all.begin(), all.end());
        all.resize(k, std::make_pair(-1, (int64)-1));
        for (const std::pair<int, int64>& one : all)
        {
            found.distances.push_back(one.first);
            found.rows.push_back(one.second);
        }
    }
    return found;
}

//! Rows of each segment's images: 3 images, one of them empty; a single row; no rows; more than a block of the scan.
const std::vector<std::vector<int>> ADDED = {{40, 0, 17}, {1}, {0, 0}, {2100, 5}};

//! An index of ADDED and its descriptors.
struct IndexFixture : public testing::Test
{
    const TemporaryFolder folder;
    std::vector<Mat> images;
    Mat queries;
    Ptr<MappedIndex> index;

    void SetUp() CV_OVERRIDE
    {
        index = MappedIndex::create(folder.name, LEVELS);
        for (const std::vector<int>& rows : ADDED)
        {
            std::vector<Mat> added;
            for (int count : rows)
                added.push_back(randomDescriptors(images.size() + added.size(), count, BYTES));
            index->add(added);
            images.insert(images.end(), added.begin(), added.end());
        }
        queries = randomDescriptors(100, 23, BYTES);
    }
    String segment(int number) const { return folder.name + format("/segment-%06d.iib", number); }
};

}  // namespace opencv_test
