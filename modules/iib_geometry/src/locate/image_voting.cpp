// SPDX-License-Identifier: Apache-2.0

#include "image_voting.hpp"

#include <algorithm>
#include <random>

namespace cv::iib {
namespace {

constexpr int TABLES = 16;
constexpr int COARSE = 4;          // bits come from the first quarter of a code: coarse cells change least
constexpr int STRONGEST = 400;     // codes of an image that vote
constexpr uint32_t FREQUENT = 64;  // entries of a key: more frequent keys do not discriminate

int participating(const Mat& codes) { return std::min(codes.rows, STRONGEST); }

}  // namespace

uint32_t ImageVoting::keyOf(const uchar* code, const std::vector<int>& bits)
{
    uint32_t key = 0;
    for (int bit : bits)
        key = key << 1 | (code[bit >> 3] >> (bit & 7) & 1u);
    return key;
}

ImageVoting::ImageVoting(const std::vector<Mat>& codes) : images_(codes.size())
{
    size_t count = 0;
    int bytes = 0;
    for (const Mat& c : codes)
    {
        count += size_t(participating(c));
        bytes = std::max(bytes, c.cols);
    }
    if (count == 0)
        return;
    int keyBits = 8;  // about one code a key
    while (keyBits < 26 && (size_t(1) << keyBits) < count)
        keyBits++;
    std::mt19937 random(1);
    for (int t = 0; t < TABLES; t++)
    {
        Table table;
        for (int i = 0; i < keyBits; i++)
            table.bits.push_back(int(random() % uint32_t(8 * bytes / COARSE)));
        table.begins.assign((size_t(1) << keyBits) + 1, 0);
        for (const Mat& c : codes)
            for (int row = 0; row < participating(c); row++)
                table.begins[keyOf(c.ptr(row), table.bits) + 1]++;
        for (size_t key = 1; key < table.begins.size(); key++)
            table.begins[key] += table.begins[key - 1];
        table.images.resize(count);
        std::vector<uint32_t> next(table.begins.begin(), table.begins.end() - 1);
        for (size_t k = 0; k < codes.size(); k++)
            for (int row = 0; row < participating(codes[k]); row++)
                table.images[next[keyOf(codes[k].ptr(row), table.bits)]++] = uint32_t(k);
        tables_.push_back(std::move(table));
    }
}

ImageVoting::Votes ImageVoting::vote(const Mat& codes) const
{
    Votes votes = {std::vector<float>(images_, 0.f), 0};
    for (const Table& table : tables_)
        for (int row = 0; row < codes.rows; row++)
        {
            const uint32_t key = keyOf(codes.ptr(row), table.bits);
            const uint32_t begin = table.begins[key], end = table.begins[key + 1];
            if (end - begin > FREQUENT)
                continue;
            votes.visited += end - begin;
            for (uint32_t i = begin; i < end; i++)
                votes.ofImages[table.images[i]] += 1.f / float(end - begin);
        }
    return votes;
}

}  // namespace cv::iib
