// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#pragma once

#include <new>

#include "kernels/hamming.hpp"

namespace cv {
namespace iib {

//! A value for each of k neighbours of each row; throws StsNoMem, with k, if memory does not hold them.
template <typename T> std::vector<T> forNeighbours(size_t rows, int k, T value)
{
    try
    {
        if ((uint64)rows * k <= std::vector<T>().max_size())
            return std::vector<T>(rows * k, value);
    }
    catch (const std::bad_alloc&)
    {
    }
    CV_Error_(
            Error::StsNoMem, ("k is %d: memory does not hold as many neighbours of each of %llu descriptors",
                                     k, (unsigned long long)rows));
}

//! The k nearest neighbours of each of many codes, in ascending order; NO_MATCH where there are fewer.
class KnnTable
{
public:
    //! `padding` more entries are there for vectors that read thresholds() past the end.
    KnnTable(size_t rows, int k_, size_t padding = 0)
        : k(k_), keys(forNeighbours(rows, k_, NO_MATCH)), nearest(rows + padding, INT_MAX)
    {
    }

    int size() const { return k; }
    size_t rows() const { return keys.size() / k; }
    MatchKey* operator[](size_t row) { return &keys[row * k]; }
    const MatchKey* operator[](size_t row) const { return &keys[row * k]; }
    //! For each row: a new neighbour with a higher index has to be nearer than this.
    const int* thresholds() const { return nearest.data(); }
    int* thresholds() { return nearest.data(); }

    void insert(size_t row, MatchKey n)
    {
        MatchKey* first = (*this)[row];
        MatchKey* last = first + k - 1;
        if (n >= *last)
            return;
        MatchKey* place = std::upper_bound(first, last, n);
        std::copy_backward(place, last, last + 1);
        *place = n;
        if (*last != NO_MATCH)
            nearest[row] = distanceOf(*last);
    }

    void merge(const KnnTable& other)
    {
        for (size_t row = 0; row < rows(); row++)
            for (int i = 0; i < k; i++)
                insert(row, other[row][i]);
    }

private:
    int k;
    std::vector<MatchKey> keys;
    std::vector<int> nearest;  // distance of the k-th
};

}  // namespace iib
}  // namespace cv
