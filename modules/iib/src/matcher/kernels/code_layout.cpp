// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "../../precomp.hpp"
#include "opencv2/iib/detail/packed_codes.hpp"

#include <cstring>

namespace cv { namespace iib {

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
            for (int i = 0; i < size; i += WORD)
                if (!split || (i / WORD % SAMPLE == 0) == (segment == 0))
                    places.push_back({width + i, std::min(size - i, WORD)});
            if (packing == PACKING_ADDERS && places.size() % 2 == 0)
                places.push_back({0, 0});
            ends.push_back((int)places.size());
        }
        width += size;
    }
    bitsBefore.push_back(0);
    for (const Place& place : places)
        bitsBefore.push_back(bitsBefore.back() + 8 * place.bytes);
}

// hot: inlined for each word of each code
inline unsigned CodeLayout::word(int i, const uchar* descriptor) const
{
    const Place place = places[i];
    unsigned result = 0;
    if (place.bytes == WORD)
        std::memcpy(&result, descriptor + place.from, WORD);
    else
        for (int b = 0; b < place.bytes; b++)
            reinterpret_cast<uchar*>(&result)[b] = descriptor[place.from + b];
    return result;
}

void CodeLayout::arrange(const uchar* descriptor, unsigned* plain) const
{
    for (int i = 0, count = words(); i < count; i++)
        plain[i] = word(i, descriptor);
}

void CodeLayout::restore(const unsigned* plain, uchar* descriptor) const
{
    for (int i = 0; i < words(); i++)
        for (int b = 0; b < places[i].bytes; b++)
            descriptor[places[i].from + b] = ((const uchar*)(plain + i))[b];
}

// Packs the words word(0), word(1), ... by PACKING_ADDERS, to words that lie `step` apart.
template <class Word> static void combine(int words, const Word& word, unsigned* packed, int step)
{
    unsigned parity = packed[0] = word(0);
    for (int i = 1; i < words; i += 2)
    {
        const unsigned first = word(i), both = first ^ word(i + 1);
        packed[i * step] = parity ^ first;
        packed[(i + 1) * step] = both;
        parity ^= both;
    }
}

void CodeLayout::pack(const unsigned* plain, unsigned* packed) const
{
    combine(
            words(), [&](int i) { return plain[i]; }, packed, 1);
}

void CodeLayout::store(const uchar* descriptor, unsigned* block, int lane) const
{
    if (packing == PACKING_ADDERS)
        return combine(
                words(), [&](int i) { return word(i, descriptor); }, block + lane, CODES_PER_BLOCK);
    for (int i = 0; i < words(); i++)
    {
        const unsigned plain = word(i, descriptor);
        for (int b = 0; b < WORD; b++)
            ((uchar*)block)[(i * WORD + b) * CODES_PER_BLOCK + lane] = ((const uchar*)&plain)[b];
    }
}

// First the plain words, code by code; then loops over lanes, which compilers vectorize.
void CodeLayout::storeBlock(const uchar* descriptors, size_t step, unsigned* block) const
{
    for (int lane = 0; lane < CODES_PER_BLOCK; lane++)
    {
        const uchar* const descriptor = descriptors + lane * step;
        for (int i = 0, count = words(); i < count; i++)
            block[i * CODES_PER_BLOCK + lane] = word(i, descriptor);
    }
    if (packing == PACKING_TABLES)
    {
        for (int i = 0; i < words(); i++)
        {
            unsigned plain[CODES_PER_BLOCK];
            uchar* to = (uchar*)(block + i * CODES_PER_BLOCK);
            std::memcpy(plain, to, sizeof(plain));
            for (int b = 0; b < WORD; b++)
                for (int lane = 0; lane < CODES_PER_BLOCK; lane++)
                    to[b * CODES_PER_BLOCK + lane] = ((const uchar*)plain)[lane * WORD + b];
        }
        return;
    }
    unsigned parity[CODES_PER_BLOCK];
    std::memcpy(parity, block, sizeof(parity));
    for (int i = 1; i < words(); i += 2)
    {
        unsigned *first = block + i * CODES_PER_BLOCK, *second = first + CODES_PER_BLOCK;
        for (int lane = 0; lane < CODES_PER_BLOCK; lane++)
        {
            second[lane] ^= first[lane];
            first[lane] ^= parity[lane];
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

}}  // namespace cv::iib
