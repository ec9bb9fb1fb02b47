// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "intrinsics.hpp"

#include "bits.hpp"
#include "mappings.hpp"

namespace cv {
namespace iib {

CV_CPU_OPTIMIZATION_NAMESPACE_BEGIN

BitsKernels<ushort> getBitsKernels(int mapping, ushort);
BitsKernels<unsigned> getBitsKernels(int mapping, unsigned);

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
inline Lanes operator>>(const Lanes& a, int bits) { return a.v >> bits; }
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

inline v_int32 loadCells(const ushort* p) { return v_reinterpret_as_s32(vx_load_expand(p)); }
inline v_int32 loadCells(const unsigned* p) { return v_reinterpret_as_s32(vx_load(p)); }
inline v_int32x4 loadCell(const ushort* p) { return v_reinterpret_as_s32(v_load_expand(p)); }
inline v_int32x4 loadCell(const unsigned* p) { return v_reinterpret_as_s32(v_load(p)); }

//! The cells of the quads of a row, and of the rows after it.
template <typename Cell> class QuadRows
{
public:
    //! Begins with quads whose top left cells are in row dy and columns dx, dx + 2, ...
    QuadRows(const CellGrid<Cell>& cells, int dy, int dx)
        : left(cells.row(dy, dx)), right(cells.row(dy, 1 - dx) + dx * GROUP_CHANNELS),  // next to odd is even
          step(cells.rowStep())
    {
    }

    //! The four cells of the quads from value i of a row on.
    void load(int i, v_int32 x[4]) const
    {
        x[0] = loadCells(left + i);
        x[1] = loadCells(right + i);
        x[2] = loadCells(left + i + step);
        x[3] = loadCells(right + i + step);
    }

    void next()
    {
        left += 2 * step;
        right += 2 * step;
    }

private:
    const Cell *left, *right;
    const size_t step;
};

//! Where the sums over quads go, row by row: the cells of the next coarser level.
class ParentRows
{
public:
    ParentRows(CellGrid<unsigned>& parents) : even(parents.row(0, 0)), odd(parents.row(0, 1)), step(parents.rowStep()) {}

    //! The quads from value i of the row on.
    void store(const v_int32 x[4], int i) const
    {
        v_uint32 sums = v_reinterpret_as_u32((x[0] + x[1]) + (x[2] + x[3]));
#if CV_SIMD_WIDTH == 16
        v_store((i / GROUP_CHANNELS % 2 ? odd : even) + i / (2 * GROUP_CHANNELS) * GROUP_CHANNELS, sums);
#else
#if CV_SIMD_WIDTH == 64
        sums = v_uint32(_mm512_shuffle_i32x4(sums.val, sums.val, 0xd8));  // quads 0, 2, 1, 3
#endif
        v_store_low(even + i / 2, sums);
        v_store_high(odd + i / 2, sums);
#endif
    }

    void next()
    {
        even += step;
        odd += step;
    }

private:
    unsigned *even, *odd;
    const size_t step;
};

template <typename Cell> void parentSums(const CellGrid<Cell>& cells, CellGrid<unsigned>& parents)
{
    const int n = cells.size() / 2;
    parents.create(n);
    QuadRows<Cell> quads(cells, 0, 0);
    ParentRows sums(parents);
    for (int r = 0; r < n; r++, quads.next(), sums.next())
        for (int i = 0; i < n * GROUP_CHANNELS; i += v_int32::nlanes)
        {
            v_int32 x[4];
            quads.load(i, x);
            sums.store(x, i);
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

/* Quads whose top left cells are in rows dy, dy + 2, ... and columns dx, dx + 2, ... WITH_PARENTS also sums the cells
 of the next coarser level, which takes dx = dy = 0. */
template <typename Mapping, bool WITH_PARENTS, typename Cell>
void windowBits(const CellGrid<Cell>& cells, const LevelShape& shape, int dy, int dx, CellGrid<unsigned>& parents,
                BitWriter& out)
{
    const int rowCount = (shape.n - dy) / 2, quads = (shape.n - dx) / 2, lanes = quads * GROUP_CHANNELS;
    const ColumnWeights columns(shape.widths + dx, quads);
    const bool equalWidths = columns.equal;
    const int* heights = shape.heights + dy;
    QuadRows<Cell> rows(cells, dy, dx);
    ParentRows sums(parents);
    RowBits bits;
    // Where a row fills whole chunks, its bits need no shifting.
    const int planeBytes = lanes / 8;
    uchar* whole = 0;
    if (shape.channels == GROUP_CHANNELS && lanes % CHUNK == 0)
        whole = out.reserve(rowCount * Mapping::BITS * planeBytes);
    for (int r = 0; r < rowCount; r++, heights += 2, rows.next(), sums.next())
    {
        const bool equalHeights = heights[0] == heights[1];
        const v_int32 topWeight = vx_setall_s32(heights[1]), bottomWeight = vx_setall_s32(heights[0]);
        for (int first = 0; first < lanes; first += CHUNK)
        {
            unsigned chunk[Mapping::BITS] = {};
            for (int lane = 0; lane < CHUNK; lane += VTraits<v_int32>::max_nlanes)
            {
                const int i = first + lane;
                v_int32 x[4];
                rows.load(i, x);
                if (WITH_PARENTS)
                    sums.store(x, i);
                if (!equalWidths)
                {
                    const v_int32 left = vx_load(columns.left + i), right = vx_load(columns.right + i);
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
                const Lanes weighted[4] = { x[0], x[1], x[2], x[3] };
                const Put put = { chunk, lane };
                Mapping::map(weighted, put);
            }
            for (int plane = 0; plane < Mapping::BITS; plane++)
                if (whole)
                    storeChunk(chunk[plane], whole + plane * planeBytes + first / 8);
                else
                    bits.planes[plane][first / CHUNK] = (ushort)chunk[plane];
        }
        if (whole)
            whole += Mapping::BITS * planeBytes;
        else
            append(bits, Mapping::BITS, quads, shape.channels, out);
    }
}

template <typename Mapping, typename Cell>
void levelBits(const CellGrid<Cell>& cells, const LevelShape& shape, CellGrid<unsigned>& parents, BitWriter& out)
{
    parents.create(shape.n / 2);
    windowBits<Mapping, true>(cells, shape, 0, 0, parents, out);
    if (!shape.overlap)
        return;
    windowBits<Mapping, false>(cells, shape, 0, 1, parents, out);
    windowBits<Mapping, false>(cells, shape, 1, 0, parents, out);
    windowBits<Mapping, false>(cells, shape, 1, 1, parents, out);
}

//! Brings the chosen quads together, cell by cell, already weighted.
template <typename Cell>
void gatherQuads(const CellGrid<Cell>& cells, const LevelShape& shape, const QuadPlace* quads, int count,
                 int gathered[4][CHUNK])
{
    for (int q = 0; q < count; q++)
    {
        const int row = quads[q].row, col = quads[q].col;
        const int left = shape.widths[col], right = shape.widths[col + 1];
        const int top = shape.heights[row], bottom = shape.heights[row + 1];
        v_int32x4 x[4] = { loadCell(cells.cell(row, col)), loadCell(cells.cell(row, col + 1)),
                           loadCell(cells.cell(row + 1, col)), loadCell(cells.cell(row + 1, col + 1)) };
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

template <typename Mapping, typename Cell>
void selectedBits(const CellGrid<Cell>& cells, const LevelShape& shape, const std::vector<QuadPlace>& quads,
                  int words, uint64* planes)
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

template <typename Cell> struct Kernels
{
    template <typename Mapping> BitsKernels<Cell> visit() const
    {
        const BitsKernels<Cell> k = { levelBits<Mapping, Cell>, selectedBits<Mapping, Cell>, parentSums<Cell> };
        return k;
    }
};

}  // namespace

BitsKernels<ushort> getBitsKernels(int mapping, ushort)
{
    return visitMapping(mapping, Kernels<ushort>());
}

BitsKernels<unsigned> getBitsKernels(int mapping, unsigned)
{
    return visitMapping(mapping, Kernels<unsigned>());
}

#endif

CV_CPU_OPTIMIZATION_NAMESPACE_END

}  // namespace iib
}  // namespace cv
