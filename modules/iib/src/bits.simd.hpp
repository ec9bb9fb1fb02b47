// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "opencv2/core/hal/intrin.hpp"

#include "bits.hpp"
#include "mappings.hpp"

namespace cv {
namespace iib {

CV_CPU_OPTIMIZATION_NAMESPACE_BEGIN

LevelBitsFunc getLevelBitsFunc(int mapping);

#ifndef CV_CPU_OPTIMIZATION_DECLARATIONS_ONLY

namespace {

enum { WORD = 64, MAX_WORDS = (1 << (MAX_GRANULARITY - 1)) * GROUP_CHANNELS / WORD, MAX_PLANES = 8 };

//! The bits of a row of quads, a plane for each bit of the mapping.
struct RowBits
{
    uint64 planes[MAX_PLANES][MAX_WORDS];

    //! Takes the comparisons of a vector of quads and channels.
    struct Put
    {
        RowBits& row;
        int lane;  //!< first one in the row

        void operator()(int plane, const v_int32& comparison) const
        {
            const uint64 bits = (uint64)(unsigned)v_signmask(comparison) << lane % WORD;
            uint64& word = row.planes[plane][lane / WORD];
            word = lane % WORD == 0 ? bits : word | bits;
        }
    };
};

/* Squeezes the channels in use together, out of each group of four lanes. Neighbouring fields of `channels` bits
 are merged, then neighbouring pairs, and so on. */
inline uint64 dropLanes(uint64 word, int channels)
{
    uint64 field = (1u << channels) - 1;
    int width = channels, distance = GROUP_CHANNELS;
    for (int i = distance; i < WORD; i *= 2)
        field |= field << i;
    word &= field;
    for (; distance < WORD; distance *= 2, width *= 2)
    {
        // the lower field of each pair stays, the upper moves down next to it
        uint64 low = width < WORD ? ((uint64)1 << width) - 1 : ~(uint64)0;
        for (int i = 2 * distance; i < WORD; i *= 2)
            low |= low << i;
        word = (word & low) | (word >> (distance - width) & low << width);
    }
    return word;
}

void append(const RowBits& row, int planes, int quads, int channels, BitWriter& out)
{
    const int lanes = quads * GROUP_CHANNELS;
    for (int plane = 0; plane < planes; plane++)
        for (int first = 0; first < lanes; first += WORD)
        {
            const int count = std::min<int>(lanes - first, WORD);
            uint64 word = row.planes[plane][first / WORD];
            if (count < WORD)
                word &= ((uint64)1 << count) - 1;
            if (channels < GROUP_CHANNELS)
                word = dropLanes(word, channels);
            out.append(word, count / GROUP_CHANNELS * channels);
        }
}

//! Weights of the left and right cells of a row of quads (see LevelShape), repeated for the channels.
struct ColumnWeights
{
    int left[MAX_WORDS * WORD], right[MAX_WORDS * WORD];
    bool trivial;

    ColumnWeights(const int* widths, int quads) : trivial(true)
    {
        for (int q = 0; q < quads; q++)
        {
            const bool equal = widths[2 * q] == widths[2 * q + 1];
            trivial = trivial && equal;
            v_store(left + q * GROUP_CHANNELS, v_setall_s32(equal ? 1 : widths[2 * q + 1]));
            v_store(right + q * GROUP_CHANNELS, v_setall_s32(equal ? 1 : widths[2 * q]));
        }
    }
};

//! Quads whose top left cells are in rows dy, dy + 2, ... and columns dx, dx + 2, ...
template <typename Mapping>
void windowBits(const CellGrid<int>& cells, const LevelShape& shape, int dy, int dx, BitWriter& out)
{
    const int rows = (shape.n - dy) / 2, quads = (shape.n - dx) / 2;
    const ColumnWeights weights(shape.widths + dx, quads);
    RowBits bits;
    for (int r = dy; r < dy + 2 * rows; r += 2)
    {
        const int *topLeft = cells.row(r, dx), *bottomLeft = cells.row(r + 1, dx);
        // right of an odd column comes the next even one
        const int *topRight = cells.row(r, 1 - dx) + dx * GROUP_CHANNELS;
        const int *bottomRight = cells.row(r + 1, 1 - dx) + dx * GROUP_CHANNELS;
        const bool equalHeights = shape.heights[r] == shape.heights[r + 1];
        const v_int32 topWeight = vx_setall_s32(shape.heights[r + 1]), bottomWeight = vx_setall_s32(shape.heights[r]);
        for (int i = 0; i < quads * GROUP_CHANNELS; i += v_int32::nlanes)
        {
            v_int32 x[4] = { vx_load(topLeft + i), vx_load(topRight + i), vx_load(bottomLeft + i),
                             vx_load(bottomRight + i) };
            if (!weights.trivial)
            {
                const v_int32 left = vx_load(weights.left + i), right = vx_load(weights.right + i);
                x[0] = x[0] * left;
                x[1] = x[1] * right;
                x[2] = x[2] * left;
                x[3] = x[3] * right;
            }
            if (!equalHeights)
            {
                x[0] = x[0] * topWeight;
                x[1] = x[1] * topWeight;
                x[2] = x[2] * bottomWeight;
                x[3] = x[3] * bottomWeight;
            }
            const RowBits::Put put = { bits, i };
            Mapping::map(x, put);
        }
        append(bits, Mapping::BITS, quads, shape.channels, out);
    }
}

template <typename Mapping> void levelBits(const CellGrid<int>& cells, const LevelShape& shape, BitWriter& out)
{
    for (int dy = 0; dy <= (int)shape.overlap; dy++)
        for (int dx = 0; dx <= (int)shape.overlap; dx++)
            windowBits<Mapping>(cells, shape, dy, dx, out);
}

}  // namespace

LevelBitsFunc getLevelBitsFunc(int mapping)
{
    switch (mapping)
    {
    case IIB::MAPPING_MAX: return levelBits<MaxMapping>;
    case IIB::MAPPING_MIN: return levelBits<MinMapping>;
    case IIB::MAPPING_QUARTILE: return levelBits<QuartileMapping>;
    case IIB::MAPPING_SORT: return levelBits<SortMapping>;
    case IIB::MAPPING_HAAR: return levelBits<HaarMapping>;
    case IIB::MAPPING_PAIRWISE: return levelBits<PairwiseMapping>;
    default: return levelBits<MeanMapping>;
    }
}

#endif

CV_CPU_OPTIMIZATION_NAMESPACE_END

}  // namespace iib
}  // namespace cv
