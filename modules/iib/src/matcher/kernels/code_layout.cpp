// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "../../precomp.hpp"
#include "code_layout.hpp"

namespace cv {
namespace iib {

static const int WORD = 4, SAMPLE = 4;  // one word in SAMPLE

CodeLayout::CodeLayout(const std::vector<int>& levelSizes, CodePacking packing_)
    : sizes(levelSizes), width(0), packing(packing_)
{
    for (int level = 0; level < levels(); level++)
    {
        const int size = sizes[level];
        const bool split = level + 1 == levels() && size > WORD;
        for (int part = 0; part < (split ? 2 : 1); part++)
        {
            int bits = 0;
            for (int i = 0; i < size; i += WORD)
                if (!split || (i / WORD % SAMPLE == 0) == (part == 0))
                {
                    const Place place = {width + i, std::min(size - i, WORD)};
                    places.push_back(place);
                    bits += 8 * place.bytes;
                }
            const Place filling = {0, 0};
            if (packing == PACKING_ADDERS && places.size() % 2 == 0)
                places.push_back(filling);
            ends.push_back((int)places.size());
            partBits.push_back(bits);
        }
        width += size;
    }
}

void CodeLayout::arrange(const uchar* descriptor, unsigned* plain) const
{
    for (int i = 0; i < words(); i++)
        if (places[i].bytes == WORD)
            std::memcpy(plain + i, descriptor + places[i].from, WORD);
        else
        {
            plain[i] = 0;
            for (int b = 0; b < places[i].bytes; b++)
                ((uchar*)(plain + i))[b] = descriptor[places[i].from + b];
        }
}

void CodeLayout::restore(const unsigned* plain, uchar* descriptor) const
{
    for (int i = 0; i < words(); i++)
        for (int b = 0; b < places[i].bytes; b++)
            descriptor[places[i].from + b] = ((const uchar*)(plain + i))[b];
}

void CodeLayout::pack(unsigned* code) const
{
    if (packing == PACKING_TABLES)
        return;
    unsigned parity = code[0];
    for (int i = 1; i < words(); i += 2)
    {
        const unsigned first = code[i], second = code[i + 1];
        code[i] = parity ^ first;
        code[i + 1] = first ^ second;
        parity ^= code[i + 1];
    }
}

void CodeLayout::store(unsigned* code, unsigned* group, int lane) const
{
    pack(code);
    if (packing == PACKING_ADDERS)
        for (int i = 0; i < words(); i++)
            group[i * CODES_PER_BLOCK + lane] = code[i];
    else
        for (int i = 0; i < words() * WORD; i++)
            ((uchar*)group)[i * CODES_PER_BLOCK + lane] = ((const uchar*)code)[i];
}

void CodeLayout::fetch(const unsigned* group, int lane, unsigned* plain) const
{
    if (packing == PACKING_TABLES)
    {
        for (int i = 0; i < words() * WORD; i++)
            ((uchar*)plain)[i] = ((const uchar*)group)[i * CODES_PER_BLOCK + lane];
        return;
    }
    unsigned parity = plain[0] = group[lane];
    for (int i = 1; i < words(); i += 2)
    {
        const unsigned first = group[i * CODES_PER_BLOCK + lane],
                       second = group[(i + 1) * CODES_PER_BLOCK + lane];
        plain[i] = parity ^ first;
        plain[i + 1] = plain[i] ^ second;
        parity ^= second;
    }
}

}  // namespace iib
}  // namespace cv
