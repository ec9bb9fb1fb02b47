// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "intrinsics.hpp"

#include "bits.hpp"
#include "mappings.hpp"

namespace cv {
namespace iib {

CV_CPU_OPTIMIZATION_NAMESPACE_BEGIN

LevelBitsFunc getLevelBitsFunc(int mapping);
SelectedBitsFunc getSelectedBitsFunc(int mapping);

#ifndef CV_CPU_OPTIMIZATION_DECLARATIONS_ONLY

namespace {

// Quads and channels that are mapped at a time, whatever the width of a vector, and their comparisons.
enum { CHUNK = 16, CHUNK_VECTORS = CHUNK / VTraits<v_int32>::max_nlanes };

//! A vector whose comparisons are bits, a bit a lane.
struct Lanes
{
    v_int32 v;

    Lanes() {}
    Lanes(const v_int32& vector) : v(vector) {}
};

inline Lanes operator+(const Lanes& a, const Lanes& b) { return a.v + b.v; }
inline Lanes operator-(const Lanes& a, const Lanes& b) { return a.v - b.v; }
inline Lanes operator<<(const Lanes& a, int bits) { return a.v << bits; }
inline Lanes v_min(const Lanes& a, const Lanes& b) { return cv::v_min(a.v, b.v); }
inline Lanes v_max(const Lanes& a, const Lanes& b) { return cv::v_max(a.v, b.v); }

#if CV_SIMD_WIDTH == 64
// Universal intrinsics turn the mask of a comparison into a vector and that into a mask again.
inline unsigned operator>(const Lanes& a, const Lanes& b) { return _mm512_cmpgt_epi32_mask(a.v.val, b.v.val); }
inline unsigned operator>=(const Lanes& a, const Lanes& b) { return _mm512_cmpge_epi32_mask(a.v.val, b.v.val); }
inline unsigned operator==(const Lanes& a, const Lanes& b) { return _mm512_cmpeq_epi32_mask(a.v.val, b.v.val); }
#else
inline unsigned operator>(const Lanes& a, const Lanes& b) { return (unsigned)v_signmask(a.v > b.v); }
inline unsigned operator>=(const Lanes& a, const Lanes& b) { return (unsigned)v_signmask(a.v >= b.v); }
inline unsigned operator==(const Lanes& a, const Lanes& b) { return (unsigned)v_signmask(a.v == b.v); }
#endif

enum { MAX_QUADS = 1 << (MAX_GRANULARITY - 1), MAX_LANES = MAX_QUADS * GROUP_CHANNELS, MAX_PLANES = 8 };

//! A row of quads: a bit for each quad and channel, in a plane for each bit of the mapping.
struct RowBits
{
    ushort planes[MAX_PLANES][MAX_LANES / CHUNK];
};

//! Collects the comparisons of a chunk.
struct Put
{
    unsigned* chunk;
    int lane;

    void operator()(int plane, unsigned bits) const { chunk[plane] |= bits << lane; }
};

/* Squeezes the channels in use together, out of each group of four lanes: neighbouring fields of `channels` bits
 are merged, then neighbouring pairs, and so on. */
inline unsigned dropLanes(unsigned chunk, int channels)
{
    switch (channels)
    {
    case 1:
        chunk &= 0x1111;
        chunk = (chunk | chunk >> 3) & 0x0303;
        return (chunk | chunk >> 6) & 0x000f;
    case 2:
        chunk &= 0x3333;
        chunk = (chunk | chunk >> 2) & 0x0f0f;
        return (chunk | chunk >> 4) & 0x00ff;
    case 3:
        chunk &= 0x7777;
        chunk = (chunk & 0x0707) | (chunk >> 1 & 0x3838);
        return (chunk & 0x003f) | (chunk >> 2 & 0x0fc0);
    default: return chunk;
    }
}

void append(const RowBits& row, int planes, int quads, int channels, BitWriter& out)
{
    const int chunkQuads = CHUNK / GROUP_CHANNELS;
    for (int plane = 0; plane < planes; plane++)
        for (int first = 0; first < quads; first += chunkQuads)
        {
            const int count = std::min(quads - first, chunkQuads) * channels;
            const unsigned bits = dropLanes(row.planes[plane][first / chunkQuads], channels);
            out.append(bits & ((1u << count) - 1), count);
        }
}

inline void storeChunk(unsigned chunk, uchar* out)
{
    out[0] = (uchar)chunk;
    out[1] = (uchar)(chunk >> 8);
}

//! Weights of the left and right cells of a row of quads (see LevelShape), repeated for the channels.
struct ColumnWeights
{
    int left[MAX_LANES], right[MAX_LANES];
    bool equal;  //!< whether all weights are 1

    ColumnWeights(const int* widths, int quads) : equal(true)
    {
        for (int q = 0; q < quads; q++)
        {
            const int l = widths[2 * q], r = widths[2 * q + 1];
            equal = equal && l == r;
            v_store(left + q * GROUP_CHANNELS, v_setall_s32(l == r ? 1 : r));
            v_store(right + q * GROUP_CHANNELS, v_setall_s32(l == r ? 1 : l));
        }
    }
};

//! Quads whose top left cells are in rows dy, dy + 2, ... and columns dx, dx + 2, ...
template <typename Mapping>
void windowBits(const CellGrid<int>& cells, const LevelShape& shape, int dy, int dx, BitWriter& out)
{
    const int rows = (shape.n - dy) / 2, quads = (shape.n - dx) / 2;
    const ColumnWeights columns(shape.widths + dx, quads);
    RowBits bits;
    // Where a row fills whole chunks, its bits need no shifting.
    const int chunks = (quads * GROUP_CHANNELS + CHUNK - 1) / CHUNK;
    uchar* whole = 0;
    if (shape.channels == GROUP_CHANNELS && chunks * CHUNK == quads * GROUP_CHANNELS)
        whole = out.reserve(rows * Mapping::BITS * chunks * (CHUNK / 8));
    for (int r = dy; r < dy + 2 * rows; r += 2)
    {
        // right of an odd column comes the next even one
        const int *topLeft = cells.row(r, dx), *topRight = cells.row(r, 1 - dx) + dx * GROUP_CHANNELS;
        const int *bottomLeft = cells.row(r + 1, dx), *bottomRight = cells.row(r + 1, 1 - dx) + dx * GROUP_CHANNELS;
        const bool equalHeights = shape.heights[r] == shape.heights[r + 1];
        const v_int32 topWeight = vx_setall_s32(shape.heights[r + 1]), bottomWeight = vx_setall_s32(shape.heights[r]);
        for (int first = 0; first < quads * GROUP_CHANNELS; first += CHUNK)
        {
            unsigned chunk[Mapping::BITS] = {};
            for (int lane = 0; lane < CHUNK; lane += VTraits<v_int32>::max_nlanes)
            {
                const int i = first + lane;
                v_int32 a = vx_load(topLeft + i), b = vx_load(topRight + i);
                v_int32 c = vx_load(bottomLeft + i), d = vx_load(bottomRight + i);
                if (!columns.equal)
                {
                    const v_int32 left = vx_load(columns.left + i), right = vx_load(columns.right + i);
                    a = a * left;
                    b = b * right;
                    c = c * left;
                    d = d * right;
                }
                if (!equalHeights)
                {
                    a = a * topWeight;
                    b = b * topWeight;
                    c = c * bottomWeight;
                    d = d * bottomWeight;
                }
                const Lanes x[4] = { a, b, c, d };
                const Put put = { chunk, lane };
                Mapping::map(x, put);
            }
            for (int plane = 0; plane < Mapping::BITS; plane++)
                if (whole)
                    storeChunk(chunk[plane], whole + (plane * chunks + first / CHUNK) * (CHUNK / 8));
                else
                    bits.planes[plane][first / CHUNK] = (ushort)chunk[plane];
        }
        if (whole)
            whole += Mapping::BITS * chunks * (CHUNK / 8);
        else
            append(bits, Mapping::BITS, quads, shape.channels, out);
    }
}

template <typename Mapping> void levelBits(const CellGrid<int>& cells, const LevelShape& shape, BitWriter& out)
{
    for (int dy = 0; dy <= (int)shape.overlap; dy++)
        for (int dx = 0; dx <= (int)shape.overlap; dx++)
            windowBits<Mapping>(cells, shape, dy, dx, out);
}

//! Brings the chosen quads together, cell by cell, already weighted.
void gatherQuads(const CellGrid<int>& cells, const LevelShape& shape, const QuadPlace* quads, int count,
                 int gathered[4][CHUNK])
{
    for (int q = 0; q < count; q++)
    {
        const int row = quads[q].row, col = quads[q].col;
        const int left = shape.widths[col], right = shape.widths[col + 1];
        const int top = shape.heights[row], bottom = shape.heights[row + 1];
        v_int32x4 x[4] = { v_load(cells.cell(row, col)), v_load(cells.cell(row, col + 1)),
                           v_load(cells.cell(row + 1, col)), v_load(cells.cell(row + 1, col + 1)) };
        if (left != right)
        {
            const v_int32x4 l = v_setall_s32(right), r = v_setall_s32(left);
            x[0] = x[0] * l;
            x[1] = x[1] * r;
            x[2] = x[2] * l;
            x[3] = x[3] * r;
        }
        if (top != bottom)
        {
            const v_int32x4 t = v_setall_s32(bottom), b = v_setall_s32(top);
            x[0] = x[0] * t;
            x[1] = x[1] * t;
            x[2] = x[2] * b;
            x[3] = x[3] * b;
        }
        for (int i = 0; i < 4; i++)
            v_store(gathered[i] + q * GROUP_CHANNELS, x[i]);
    }
}

template <typename Mapping>
void selectedBits(const CellGrid<int>& cells, const LevelShape& shape, const std::vector<QuadPlace>& quads, int words,
                  uint64* planes)
{
    const int chunkQuads = CHUNK / GROUP_CHANNELS, wordChunks = 64 / CHUNK, count = (int)quads.size();
    std::fill(planes, planes + words * Mapping::BITS, (uint64)0);
    int gathered[4][CHUNK] = {};
    for (int first = 0; first < count; first += chunkQuads)
    {
        gatherQuads(cells, shape, &quads[first], std::min(chunkQuads, count - first), gathered);
        unsigned chunk[Mapping::BITS] = {};
        for (int lane = 0; lane < CHUNK; lane += VTraits<v_int32>::max_nlanes)
        {
            const Lanes x[4] = { vx_load(gathered[0] + lane), vx_load(gathered[1] + lane), vx_load(gathered[2] + lane),
                                 vx_load(gathered[3] + lane) };
            const Put put = { chunk, lane };
            Mapping::map(x, put);
        }
        const int index = first / chunkQuads;
        for (int plane = 0; plane < Mapping::BITS; plane++)
            planes[plane * words + index / wordChunks] |= (uint64)chunk[plane] << index % wordChunks * CHUNK;
    }
}

struct LevelBits
{
    template <typename Mapping> LevelBitsFunc visit() const { return levelBits<Mapping>; }
};

struct SelectedBits
{
    template <typename Mapping> SelectedBitsFunc visit() const { return selectedBits<Mapping>; }
};

}  // namespace

LevelBitsFunc getLevelBitsFunc(int mapping)
{
    return visitMapping(mapping, LevelBits());
}

SelectedBitsFunc getSelectedBitsFunc(int mapping)
{
    return visitMapping(mapping, SelectedBits());
}

#endif

CV_CPU_OPTIMIZATION_NAMESPACE_END

}  // namespace iib
}  // namespace cv
