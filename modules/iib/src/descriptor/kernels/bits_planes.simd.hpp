// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#pragma once

// Where comparisons lie in memory, and how they become bits of a descriptor.

#include "../../common/vectors.simd.hpp"
#include "quads.hpp"

namespace cv {
namespace iib {

CV_CPU_OPTIMIZATION_NAMESPACE_BEGIN

namespace {

//! Lanes, one for each channel of a quad, that are mapped at a time.
constexpr int CHUNK = QuadPhase::CHUNK;

//! A chunk in vectors V.
template <typename V> struct Chunk
{
    static constexpr int LANES = VTraits<V>::max_nlanes, VECTORS = CHUNK / LANES;
};

//! Writes the bits of chunks to planes in memory, two bytes for each plane.
struct PlaneRows
{
    uchar* first;
    size_t plane, row;  //!< from a plane or row to the next one, in bytes

    //! A chunk of each plane of a row.
    template <int PLANES> void storeRow(const unsigned chunks[PLANES])
    {
        for (int p = 0; p < PLANES; p++)
            storeBytes(chunks[p], CHUNK / 8, first + p * plane);
        first += row;
    }

    void nextChunk() { first += CHUNK / 8; }
};

//! Squeezes the channels in use together, out of each group of four lanes: first neighbouring groups, then pairs of groups.
inline unsigned dropLanes(unsigned chunk, int channels)
{
    if (channels == GROUP_CHANNELS)
        return chunk;
    const int unused = GROUP_CHANNELS - channels;
    const unsigned groups = 0x0101 * ((1u << channels) - 1), pair = (1u << 2 * channels) - 1;
    chunk = (chunk & groups) | (chunk >> unused & groups << channels);
    return (chunk & pair) | (chunk >> 2 * unused & pair << 2 * channels);
}

//! Appends the lowest `lanes` bits of a chunk without those of channels that are not in use.
inline void appendChunk(unsigned chunk, int lanes, int channels, BitAppender& out)
{
    const int count = lanes / GROUP_CHANNELS * channels;
    out.append(dropLanes(chunk, channels) & ((1u << count) - 1), count);
}

//! Appends the `lanes` bits of a plane without those of channels that are not in use.
inline void append(const uchar* plane, int lanes, int channels, BitAppender& out)
{
    if (channels == GROUP_CHANNELS)
        for (int first = 0; first < lanes; first += 64)
        {
            const int count = std::min(lanes - first, 64);
            out.append(loadWord(plane + first / 8) & ~(uint64)0 >> (64 - count), count);
        }
    else
        for (int first = 0; first < lanes; first += CHUNK)
        {
            const uchar* p = plane + first / 8;
            appendChunk(p[0] | p[1] << 8, std::min(lanes - first, CHUNK), channels, out);
        }
}

//! Appends the comparisons of all quads of a phase.
inline void append(PlaneRows planes, const QuadPhase& phase, int bits, int channels, BitAppender& out)
{
    BitAppender writer = out;  // a copy, which stores to uchar* surely do not change
    for (int r = 0; r < phase.rows; r++, planes.first += planes.row)
        for (int plane = 0; plane < bits; plane++)
            append(planes.first + plane * planes.plane, phase.lanes(), channels, writer);
    out = writer;
}

/* Where the bits of rows shorter than a chunk go, one plane after another. They stay in registers: to load a word whose
 bytes have just been stored one by one, a processor waits until the stores are done. */
class ShortRowWriter
{
public:
    ShortRowWriter(BitAppender& out_, int lanes, int channels_)
        : out(out_), channels(channels_), count(lanes / GROUP_CHANNELS * channels), mask((1u << count) - 1)
    {
    }

    template <int PLANES> void storeRow(const unsigned chunks[PLANES])
    {
        constexpr int TOGETHER =
                PLANES % 4 == 0 ? 4 : PLANES;  // planes, of twelve bits at most, that fit a word
        for (int p = 0; p < PLANES; p += TOGETHER)
        {
            uint64 bits = 0;
            for (int i = 0; i < TOGETHER; i++)
                bits |= (uint64)(dropLanes(chunks[p + i], channels) & mask) << i * count;
            out.append(bits, TOGETHER * count);
        }
    }

    void nextChunk() {}

private:
    BitAppender& out;
    const int channels, count;
    const unsigned mask;
};

}  // namespace

CV_CPU_OPTIMIZATION_NAMESPACE_END

}  // namespace iib
}  // namespace cv
