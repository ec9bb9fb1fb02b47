// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "selection.hpp"

namespace cv {
namespace iib {

/* A parallel suffix: moves[i] holds the bits that go 2^i places down, after the moves before it.
 See H. S. Warren, Hacker's Delight, section 7-4 ("compress"). */
ChosenBits::Compressor::Compressor(uint64 mask_) : mask(mask_), count(0)
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

uint64 ChosenBits::Compressor::operator()(uint64 bits) const
{
    bits &= mask;
    for (int i = 0; i < 6; i++)
    {
        const uint64 moved = bits & moves[i];
        bits = (bits ^ moved) | moved >> (1 << i);
    }
    return bits;
}

ChosenBits::ChosenBits(const Parameters& p, int level, int group, int phase)
{
    const QuadPhase w(1 << level, phase);
    const int planes = bitsPerQuad(p.mapping), planeBits = 8 * w.planeBytes();
    std::vector<uint64> masks((w.rows * planes * planeBits + 63) / 64, 0);
    for (int i = 0; i < p.selection.rows; i++)
    {
        const int* quad = p.selection[i];
        const int channel = quad[1], row = quad[2], col = quad[3];
        if (quad[0] != level || channel / GROUP_CHANNELS != group || row % 2 != w.dy || col % 2 != w.dx)
            continue;
        for (int plane = 0; plane < planes; plane++)
        {
            const int bit = (row / 2 * planes + plane) * planeBits + col / 2 * GROUP_CHANNELS +
                            channel % GROUP_CHANNELS;
            masks[bit / 64] |= (uint64)(quad[4] >> plane & 1) << bit % 64;
        }
    }
    for (size_t i = 0; i < masks.size(); i++)
        if (masks[i])
            words.push_back(Word{8 * i, Compressor(masks[i])});
}

}  // namespace iib
}  // namespace cv
