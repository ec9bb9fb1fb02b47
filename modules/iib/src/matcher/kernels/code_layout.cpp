// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "../../precomp.hpp"
#include "code_layout.hpp"

#include <cstring>

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
        for (int segment = 0; segment < (split ? 2 : 1); segment++)
        {
            int bits = 0;
            for (int i = 0; i < size; i += WORD)
                if (!split || (i / WORD % SAMPLE == 0) == (segment == 0))
                {
                    const Place place = {width + i, std::min(size - i, WORD)};
                    places.push_back(place);
                    bits += 8 * place.bytes;
                }
            const Place filling = {0, 0};
            if (packing == PACKING_ADDERS && places.size() % 2 == 0)
                places.push_back(filling);
            ends.push_back((int)places.size());
            segmentBits.push_back(bits);
        }
        width += size;
    }
}

void CodeLayout::arrange(const uchar* descriptor, unsigned* plain) const
{
    for (int i = 0; i < words(); i++)
        gather(i, descriptor, 0, 1, plain + i);
}

void CodeLayout::gather(int i, const uchar* descriptors, size_t step, int count, unsigned* to) const
{
    const Place place = places[i];
    descriptors += place.from;
    if (place.bytes == WORD)
        for (int lane = 0; lane < count; lane++)
            std::memcpy(to + lane, descriptors + lane * step, WORD);
    else
        for (int lane = 0; lane < count; lane++)
        {
            to[lane] = 0;
            for (int b = 0; b < place.bytes; b++)
                ((uchar*)(to + lane))[b] = descriptors[lane * step + b];
        }
}

void CodeLayout::restore(const unsigned* plain, uchar* descriptor) const
{
    for (int i = 0; i < words(); i++)
        for (int b = 0; b < places[i].bytes; b++)
            descriptor[places[i].from + b] = ((const uchar*)(plain + i))[b];
}

void CodeLayout::pack(const unsigned* plain, unsigned* packed) const
{
    unsigned parity = packed[0] = plain[0];
    for (int i = 1; i < words(); i += 2)
    {
        packed[i] = parity ^ plain[i];
        packed[i + 1] = plain[i] ^ plain[i + 1];
        parity ^= packed[i + 1];
    }
}

void CodeLayout::store(const uchar* descriptor, unsigned* block, int lane) const
{
    unsigned first, second, parity;
    if (packing == PACKING_TABLES)
    {
        for (int i = 0; i < words(); i++)
        {
            gather(i, descriptor, 0, 1, &first);
            uchar* to = (uchar*)(block + i * CODES_PER_BLOCK) + lane;
            for (int b = 0; b < WORD; b++)
                to[b * CODES_PER_BLOCK] = ((const uchar*)&first)[b];
        }
        return;
    }
    gather(0, descriptor, 0, 1, &parity);
    block[lane] = parity;
    for (int i = 1; i < words(); i += 2)
    {
        gather(i, descriptor, 0, 1, &first);
        gather(i + 1, descriptor, 0, 1, &second);
        block[i * CODES_PER_BLOCK + lane] = parity ^ first;
        block[(i + 1) * CODES_PER_BLOCK + lane] = first ^ second;
        parity ^= first ^ second;
    }
}

// Its loops run over the lanes, so that compilers make vectors of them.
void CodeLayout::storeBlock(const uchar* descriptors, size_t step, unsigned* block) const
{
    unsigned first[CODES_PER_BLOCK], second[CODES_PER_BLOCK], parity[CODES_PER_BLOCK];
    if (packing == PACKING_TABLES)
    {
        for (int i = 0; i < words(); i++)
        {
            gather(i, descriptors, step, CODES_PER_BLOCK, first);
            uchar* to = (uchar*)(block + i * CODES_PER_BLOCK);
            for (int b = 0; b < WORD; b++)
                for (int lane = 0; lane < CODES_PER_BLOCK; lane++)
                    to[b * CODES_PER_BLOCK + lane] = ((const uchar*)first)[lane * WORD + b];
        }
        return;
    }
    gather(0, descriptors, step, CODES_PER_BLOCK, parity);
    std::copy(parity, parity + CODES_PER_BLOCK, block);
    for (int i = 1; i < words(); i += 2)
    {
        gather(i, descriptors, step, CODES_PER_BLOCK, first);
        gather(i + 1, descriptors, step, CODES_PER_BLOCK, second);
        unsigned* to = block + i * CODES_PER_BLOCK;
        for (int lane = 0; lane < CODES_PER_BLOCK; lane++)
        {
            to[lane] = parity[lane] ^ first[lane];
            second[lane] ^= first[lane];
            to[CODES_PER_BLOCK + lane] = second[lane];
            parity[lane] ^= second[lane];
        }
    }
}

void CodeLayout::fetch(const unsigned* block, int lane, unsigned* plain) const
{
    if (packing == PACKING_TABLES)
    {
        for (int i = 0; i < words() * WORD; i++)
            ((uchar*)plain)[i] = ((const uchar*)block)[i * CODES_PER_BLOCK + lane];
        return;
    }
    unsigned parity = plain[0] = block[lane];
    for (int i = 1; i < words(); i += 2)
    {
        const unsigned first = block[i * CODES_PER_BLOCK + lane],
                       second = block[(i + 1) * CODES_PER_BLOCK + lane];
        plain[i] = parity ^ first;
        plain[i + 1] = plain[i] ^ second;
        parity ^= second;
    }
}

}  // namespace iib
}  // namespace cv
