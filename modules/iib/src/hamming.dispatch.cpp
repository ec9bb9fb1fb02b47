// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "precomp.hpp"
#include "hamming.hpp"

#include "hamming.simd.hpp"
#include "hamming.simd_declarations.hpp"

namespace cv {
namespace iib {

HammingLayout::HammingLayout(const std::vector<int>& levelSizes) : sizes(levelSizes), width(0)
{
    for (size_t i = 0; i < sizes.size(); i++)
    {
        const int words = (sizes[i] + 3) / 4;
        ends.push_back(i == 0 ? words / 2 : ends.back() + (words + 1) / 2);
        width += sizes[i];
    }
}

int HammingLayout::bits(int steps) const
{
    int before = 0, level = 0, from = 0; // bits and words of the levels before
    for (; level < levels() && end(level) <= steps; from = 1 + 2 * end(level++))
        before += 8 * sizes[level];
    return level == levels() ? before : before + std::min(8 * sizes[level], 32 * (1 + 2 * steps - from));
}

void HammingLayout::pack(const uchar* descriptor, unsigned* code) const
{
    std::fill(code, code + words(), 0u);
    for (int level = 0, word = 0; level < levels(); word = 1 + 2 * end(level++))
    {
        std::memcpy(code + word, descriptor, sizes[level]);
        descriptor += sizes[level];
    }
    unsigned parity = code[0];
    for (int i = 1; i < words(); i += 2)
    {
        const unsigned first = code[i], second = code[i + 1];
        code[i] = parity ^ first;
        code[i + 1] = first ^ second;
        parity ^= code[i + 1];
    }
}

void HammingLayout::unpack(const unsigned* code, uchar* descriptor) const
{
    std::vector<unsigned> plain(code, code + words());
    unsigned parity = plain[0];
    for (int i = 1; i < words(); i += 2)
    {
        plain[i] = parity ^ code[i];
        plain[i + 1] = plain[i] ^ code[i + 1];
        parity ^= code[i + 1];
    }
    for (int level = 0, word = 0; level < levels(); word = 1 + 2 * end(level++))
    {
        std::memcpy(descriptor, &plain[word], sizes[level]);
        descriptor += sizes[level];
    }
}

void hammingScan(const HammingScan& scan)
{
    CV_CPU_DISPATCH(hammingScan, (scan), CV_CPU_DISPATCH_MODES_ALL);
}

const char* hammingInstructionSet()
{
    CV_CPU_DISPATCH(hammingInstructionSet, (), CV_CPU_DISPATCH_MODES_ALL);
}

}  // namespace iib
}  // namespace cv
