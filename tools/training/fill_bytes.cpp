// SPDX-License-Identifier: Apache-2.0

#include <algorithm>
#include <array>
#include <numeric>

#include "select.hpp"

namespace iib_tools {
namespace {

typedef std::array<int, 8> Levels;  // indexed by level; 0 and 7 are unused

//! The whole bytes nearest to the wanted numbers of bits, limited by the pool and by `most` in all.
Levels roundLevels(const Levels& wanted, const Levels& available, int most)
{
    Levels rounded = {}, order = {};
    int sum = 0;
    for (size_t level = 0; level < wanted.size(); level++)
    {
        rounded[level] = wanted[level] / 8 * 8;
        sum += rounded[level];
    }
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(order.begin(), order.end(),
            [&](int a, int b) { return wanted[a] - rounded[a] > wanted[b] - rounded[b]; });
    for (bool grown = true; grown;)
    {
        grown = false;
        for (int level : order)
            if (sum + 8 <= most && wanted[level] > 0 && rounded[level] + 8 <= available[level])
            {
                rounded[level] += 8;
                sum += 8;
                grown = true;
            }
    }
    return rounded;
}

}  // namespace

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
    Levels left = roundLevels(wanted, available, bits);

    // chosen candidates first, then the others, each by benefit
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
