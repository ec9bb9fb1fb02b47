// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "selection.hpp"

#include <map>

namespace cv {
namespace iib {

/* A parallel suffix: moves[i] holds the bits that go 2^i places down, after the moves before it.
 See H. S. Warren, Hacker's Delight, section 7-4 ("compress"). */
SelectedQuads::Compressor::Compressor(uint64 mask_) : mask(mask_), count(0)
{
    for (uint64 m = mask; m; m &= m - 1)
        count++;
    uint64 left = mask, zerosBelow = ~mask << 1;
    for (int i = 0; i < 6; i++)
    {
        uint64 odd = zerosBelow;  // bit k: whether the zeros below it are odd in number
        for (int s = 1; s < 64; s *= 2)
            odd ^= odd << s;
        moves[i] = odd & left;
        left = (left ^ moves[i]) | moves[i] >> (1 << i);
        zerosBelow &= ~odd;
    }
}

uint64 SelectedQuads::Compressor::operator()(uint64 bits) const
{
    bits &= mask;
    for (int i = 0; i < 6; i++)
    {
        const uint64 moved = bits & moves[i];
        bits = (bits ^ moved) | moved >> (1 << i);
    }
    return bits;
}

SelectedQuads::SelectedQuads(const Parameters& p, int level, int group)
{
    // Row by row of places, what each of the group's channels keeps.
    typedef std::array<int, GROUP_CHANNELS> Masks;
    std::map<std::pair<int, int>, Masks> chosen;
    for (int i = 0; i < p.selection.rows; i++)
    {
        const int* quad = p.selection[i];
        if (quad[0] == level && quad[1] / GROUP_CHANNELS == group)
            chosen.insert(std::make_pair(std::make_pair(quad[2], quad[3]), Masks())).first->second[quad[1] % GROUP_CHANNELS]
                |= quad[4];
    }

    std::vector<Masks> masks;
    for (const auto& place : chosen)
    {
        quads.push_back(QuadPlace{ place.first.first, place.first.second });
        masks.push_back(place.second);
    }
    for (int plane = 0; plane < bitsPerQuad(p.mapping); plane++)
        for (size_t first = 0; first < masks.size(); first += WORD_QUADS)
        {
            uint64 word = 0;
            for (size_t q = first; q < std::min(first + WORD_QUADS, masks.size()); q++)
                for (int c = 0; c < GROUP_CHANNELS; c++)
                    word |= (uint64)(masks[q][c] >> plane & 1) << ((q - first) * GROUP_CHANNELS + c);
            compressors.push_back(Compressor(word));
        }
}

void SelectedQuads::append(const uint64* planes, BitWriter& out) const
{
    for (size_t i = 0; i < compressors.size(); i++)
        out.append(compressors[i](planes[i]), compressors[i].count);
}

}  // namespace iib
}  // namespace cv
