// SPDX-License-Identifier: Apache-2.0

#include <algorithm>
#include <array>
#include <numeric>

#include "select.hpp"

namespace iib_tools {
namespace {

typedef std::array<int, 8> Levels;  // indexed by level, 0 and 7 stay empty

int candidatesPerByte(const CandidatePool& pool)
{
    int count = 1;
    while (count * pool.bitsPerCandidate() % 8 != 0)
        count *= 2;
    return count;
}

//! Whole bytes nearest to the wanted numbers, within what the pool has and `most` in all.
Levels roundLevels(const Levels& wanted, const Levels& available, int step, int most)
{
    Levels rounded = {}, order = {};
    int sum = 0;
    for (size_t level = 0; level < wanted.size(); level++)
    {
        rounded[level] = wanted[level] / step * step;
        sum += rounded[level];
    }
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(order.begin(), order.end(),
            [&](int a, int b) { return wanted[a] - rounded[a] > wanted[b] - rounded[b]; });
    for (bool grown = true; grown;)
    {
        grown = false;
        for (int level : order)
            if (sum + step <= most && wanted[level] > 0 && rounded[level] + step <= available[level])
            {
                rounded[level] += step;
                sum += step;
                grown = true;
            }
    }
    return rounded;
}

}  // namespace

int candidateCount(const CandidatePool& pool, int bits)
{
    const int count = bits / pool.bitsPerCandidate(), most = int(pool.candidates.size());
    if (count < 1 || count > most)
        CV_Error(cv::Error::StsOutOfRange, cv::format("%d bits are not 1 to %d candidates of %d bits", bits,
                                                   most, pool.bitsPerCandidate()));
    return count;
}

std::vector<int> fillBytes(const CandidatePool& pool, const std::vector<int>& chosen,
        const std::vector<double>& benefit, int bits)
{
    Levels wanted = {}, available = {};
    std::vector<bool> isChosen(pool.candidates.size());
    for (int i : chosen)
    {
        wanted[pool.level(pool.candidates[i])]++;
        isChosen[i] = true;
    }
    for (size_t i = 0; i < pool.candidates.size(); i++)
        available[pool.level(pool.candidates[i])] += isChosen[i] || benefit[i] > 0;
    Levels left = roundLevels(wanted, available, candidatesPerByte(pool), bits / pool.bitsPerCandidate());

    // the chosen ones first, then the others, each by benefit
    std::vector<int> order(pool.candidates.size()), filled;
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(order.begin(), order.end(),
            [&](int a, int b) { return isChosen[a] != isChosen[b] ? isChosen[a] : benefit[a] > benefit[b]; });
    for (int i : order)
        if (left[pool.level(pool.candidates[i])]-- > 0)
            filled.push_back(i);
    std::sort(filled.begin(), filled.end());
    return filled;
}

}  // namespace iib_tools
