// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "../../precomp.hpp"

#include "kernels.simd.hpp"
#include "descriptor/kernels/kernels.simd_declarations.hpp"

namespace cv {
namespace iib {

const DescriptorKernels& descriptorKernels()
{
    CV_CPU_DISPATCH(descriptorKernels, (), CV_CPU_DISPATCH_MODES_ALL);
}

/* A parallel suffix: moves[i] holds the bits that go 2^i places down, after the moves before it.
 See H. S. Warren, Hacker's Delight, section 7-4 ("compress"). */
BitCompressor::BitCompressor(uint64 mask_) : mask(mask_), count(0)
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

uint64 BitCompressor::operator()(uint64 bits) const
{
    bits &= mask;
    for (int i = 0; i < 6; i++)
    {
        const uint64 moved = bits & moves[i];
        bits = (bits ^ moved) | moved >> (1 << i);
    }
    return bits;
}

ChosenBits::ChosenBits(const std::vector<uint64>& masks)
{
    for (size_t i = 0; i < masks.size(); i++)
        if (masks[i])
            chosen.push_back(Word{8 * i, BitCompressor(masks[i])});
}

}  // namespace iib
}  // namespace cv
