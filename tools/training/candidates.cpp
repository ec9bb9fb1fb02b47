// SPDX-License-Identifier: Apache-2.0

#include "candidates.hpp"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <map>

#include "opencv2/iib/detail/places.hpp"

namespace iib_tools {
namespace {

using namespace cv::iib;

//! All quads in the order of their bits in a descriptor.
cv::Mat_<int> allQuads(const PoolParameters& p, int mask)
{
    cv::Mat_<int> quads(0, 5);
    const int channels = countBits(p.channels);
    for (int level = 1; level <= p.granularity; level++)
    {
        const int windows = p.windows[std::min(level, int(p.windows.size())) - 1];
        for (int group = 0; group < channels; group += GROUP_CHANNELS)
            for (int window = 0; window < 4; window++)
                for (int row = window / 2; (windows >> window & 1) && row + 1 < 1 << level; row += 2)
                    for (int column = window % 2; column + 1 < 1 << level; column += 2)
                        for (int channel = group; channel < std::min(group + GROUP_CHANNELS, channels);
                                channel++)
                            quads.push_back(cv::Mat_<int>({level, channel, row, column, mask}).reshape(1, 1));
    }
    return quads;
}

//! Whether the bits of two quads of a level are in one row of planes.
bool inOneRow(const int* p, const int* q)
{
    return p[0] == q[0] && p[1] / GROUP_CHANNELS == q[1] / GROUP_CHANNELS && p[2] == q[2] &&
           p[3] % 2 == q[3] % 2;
}

void addQuads(const PoolParameters& p, CandidatePool& pool)
{
    const int bits = bitsPerQuad(p.mapping);
    pool.quads = allQuads(p, (1 << bits) - 1);
    pool.extractor->setSelection(pool.quads);

    int start = 0;  // first bit of a row of planes
    for (int first = 0; first < pool.quads.rows;)
    {
        if (first > 0 && pool.quads(first, 0) != pool.quads(first - 1, 0))
            start = (start + 7) / 8 * 8;  // a level begins at a whole byte
        int last = first;
        while (last < pool.quads.rows && inOneRow(pool.quads[first], pool.quads[last]))
            last++;
        for (int quad = first; quad < last; quad++)
            for (int bit = 0; bit < bits; bit++)
                pool.candidates.push_back({quad, 1 << bit, start + bit * (last - first) + quad - first});
        start += (last - first) * bits;
        first = last;
    }
}

//! All bits of boxes in the order of a descriptor, see IIBDescriptorExtractor::MAPPING_BOXES.
void addBoxes(const PoolParameters& p, CandidatePool& pool)
{
    const struct
    {
        int kind, bit;
    } ownBits[] = {{IIB::CHANNEL_GRAD_X, 3}, {IIB::CHANNEL_SIGNED_GRAD_X, 4}, {IIB::CHANNEL_SIGNED_GRAD_Y, 3},
            {IIB::CHANNEL_SIGNED_GRAD_Y, 4}, {IIB::CHANNEL_SIGNED_GRAD_X, 3}};
    std::map<std::array<int, 4>, int> rows;  // level, channel, row and column -> row of pool.quads
    int position = 0;
    const auto add = [&](int level, int kind, int row, int column, int bit) {
        const int index = countBits(p.channels & (kind - 1));
        if (!(p.channels & kind))
            return;
        const auto quad = rows.insert({{{level, index, row, column}}, pool.quads.rows});
        if (quad.second)
            pool.quads.push_back(cv::Mat_<int>({level, index, row, column, 0}).reshape(1, 1));
        pool.quads(quad.first->second, 4) |= 1 << bit;
        pool.candidates.push_back({quad.first->second, 1 << bit, position++});
    };
    for (int level = 1; level <= p.granularity; level++)
    {
        const int n = placesInRow(p.mapping, level);
        position = (position + 7) / 8 * 8;
        for (int row = 0; row + 1 < n; row++)
            for (int bit = 0; bit < 3; bit++)
                for (int column = 0; column + 1 < n; column++)
                    for (int kind : {IIB::CHANNEL_GRAD_X, IIB::CHANNEL_GRAD_Y, IIB::CHANNEL_SIGNED_GRAD_X,
                                 IIB::CHANNEL_SIGNED_GRAD_Y, IIB::CHANNEL_INTENSITY})
                        add(level, kind, row, column, bit);
        for (int row = 0; row < n; row++)
            for (int column = 0; column < n; column++)
                for (const auto& bit : ownBits)
                    add(level, bit.kind, row, column, bit.bit);
    }
    pool.extractor->setSelection(pool.quads);
}

}  // namespace

bool CandidatePool::areNeighbours(const Candidate& a, const Candidate& b) const
{
    const int *p = quads[a.quad], *q = quads[b.quad];
    return a.mask == b.mask && p[0] == q[0] && p[1] == q[1] && std::abs(p[2] - q[2]) <= 1 &&
           std::abs(p[3] - q[3]) <= 1;
}

int countBits(int mask)
{
    int n = 0;
    for (; mask; mask &= mask - 1)
        n++;
    return n;
}

CandidatePool makePool(const PoolParameters& p)
{
    CandidatePool pool;
    pool.extractor = IIB::create(p.scale, p.granularity, p.channels, p.mapping);
    pool.extractor->setBorder(p.border);
    if (p.mapping == IIB::MAPPING_BOXES)
        addBoxes(p, pool);
    else
        addQuads(p, pool);
    return pool;
}

cv::Mat_<int> selectionOf(const CandidatePool& pool, const std::vector<int>& chosen)
{
    std::map<int, int> masks;
    for (int i : chosen)
        masks[pool.candidates[i].quad] |= pool.candidates[i].mask;
    cv::Mat_<int> rows(0, 5);
    for (const std::pair<const int, int>& quad : masks)
    {
        cv::Mat_<int> row = pool.quads.row(quad.first).clone();
        row(4) = quad.second;
        rows.push_back(row);
    }
    return rows;
}

cv::Ptr<IIB> selectedExtractor(const CandidatePool& pool, const std::vector<int>& chosen)
{
    const cv::Ptr<IIB> extractor = IIB::create(pool.extractor->getScaleFactor(),
            pool.extractor->getGranularity(), pool.extractor->getChannels(), pool.extractor->getMapping());
    extractor->setSelection(selectionOf(pool, chosen));
    return extractor;
}

}  // namespace iib_tools
