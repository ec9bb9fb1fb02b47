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
enum { CHUNK = Window::CHUNK, LANES = VTraits<v_int32>::max_nlanes, CHUNK_VECTORS = CHUNK / LANES };

//! A vector whose comparisons are bits, a bit a lane.
template <typename V> struct Lanes
{
    V v;

    Lanes() {}
    Lanes(const V& vector) : v(vector) {}
};

template <typename V> inline Lanes<V> operator+(const Lanes<V>& a, const Lanes<V>& b) { return a.v + b.v; }
template <typename V> inline Lanes<V> operator-(const Lanes<V>& a, const Lanes<V>& b) { return a.v - b.v; }
template <typename V> inline Lanes<V> operator<<(const Lanes<V>& a, int bits) { return a.v << bits; }
template <typename V> inline Lanes<V> operator>>(const Lanes<V>& a, int bits) { return a.v >> bits; }
template <typename V> inline Lanes<V> v_min(const Lanes<V>& a, const Lanes<V>& b) { return cv::v_min(a.v, b.v); }
template <typename V> inline Lanes<V> v_max(const Lanes<V>& a, const Lanes<V>& b) { return cv::v_max(a.v, b.v); }
template <typename V> inline unsigned operator>(const Lanes<V>& a, const Lanes<V>& b) { return (unsigned)v_signmask(a.v > b.v); }
template <typename V> inline unsigned operator>=(const Lanes<V>& a, const Lanes<V>& b) { return (unsigned)v_signmask(a.v >= b.v); }
template <typename V> inline unsigned operator==(const Lanes<V>& a, const Lanes<V>& b) { return (unsigned)v_signmask(a.v == b.v); }

#if CV_SIMD_WIDTH == 64
// Universal intrinsics turn the mask of a comparison into a vector and that into a mask again.
inline unsigned operator>(const Lanes<v_int32>& a, const Lanes<v_int32>& b) { return _mm512_cmpgt_epi32_mask(a.v.val, b.v.val); }
inline unsigned operator>=(const Lanes<v_int32>& a, const Lanes<v_int32>& b) { return _mm512_cmpge_epi32_mask(a.v.val, b.v.val); }
inline unsigned operator==(const Lanes<v_int32>& a, const Lanes<v_int32>& b) { return _mm512_cmpeq_epi32_mask(a.v.val, b.v.val); }
#endif

enum { MAX_QUADS = 1 << (MAX_GRANULARITY - 1), MAX_LANES = MAX_QUADS * GROUP_CHANNELS };

//! Collects comparisons, from a lane on.
struct Put
{
    unsigned* planes;
    int lane;

    void operator()(int plane, unsigned bits) const { planes[plane] |= bits << lane; }
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

inline v_int32 loadCells(const ushort* p) { return v_reinterpret_as_s32(vx_load_expand(p)); }
inline v_int32 loadCells(const unsigned* p) { return v_reinterpret_as_s32(vx_load(p)); }
inline v_int32x4 loadCell(const ushort* p) { return v_reinterpret_as_s32(v_load_expand(p)); }
inline v_int32x4 loadCell(const unsigned* p) { return v_reinterpret_as_s32(v_load(p)); }

//! The cells of a chunk of quads, and of those in the rows below it.
template <typename Cell> class QuadRows
{
public:
    //! Begins with quads whose top left cells are in row dy and columns dx, dx + 2, ..., at value `first` of the row.
    QuadRows(const CellGrid<Cell>& cells, int dy, int dx, int first)
        : left(cells.row(dy, dx) + first), right(cells.row(dy, 1 - dx) + dx * GROUP_CHANNELS + first),
          step(cells.rowStep())  // next to an odd column is an even one
    {
    }

    void load(int lane, v_int32 x[4]) const
    {
        x[0] = loadCells(left + lane);
        x[1] = loadCells(right + lane);
        x[2] = loadCells(left + step + lane);
        x[3] = loadCells(right + step + lane);
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

//! Where the sums over such quads go: the cells of the next coarser level.
class ParentRows
{
public:
    ParentRows(CellGrid<unsigned>& parents, int first)
        : even(parents.row(0, 0) + first / 2), odd(parents.row(0, 1) + first / 2), step(parents.rowStep())
    {
    }

    void store(int lane, const v_int32 x[4]) const
    {
        v_uint32 sums = v_reinterpret_as_u32((x[0] + x[1]) + (x[2] + x[3]));
#if CV_SIMD_WIDTH == 16
        v_store((lane / GROUP_CHANNELS % 2 ? odd : even) + lane / (2 * GROUP_CHANNELS) * GROUP_CHANNELS, sums);
#else
#if CV_SIMD_WIDTH == 64
        sums = v_uint32(_mm512_shuffle_i32x4(sums.val, sums.val, 0xd8));  // quads 0, 2, 1, 3
#endif
        v_store_low(even + lane / 2, sums);
        v_store_high(odd + lane / 2, sums);
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
    for (int first = 0; first < n * GROUP_CHANNELS; first += CHUNK)
    {
        QuadRows<Cell> quads(cells, 0, 0, first);
        ParentRows sums(parents, first);
        for (int r = 0; r < n; r++, quads.next(), sums.next())
            for (int lane = 0; lane < CHUNK; lane += LANES)
            {
                v_int32 x[4];
                quads.load(lane, x);
                sums.store(lane, x);
            }
    }
}

/* Four numbers, each repeated for the channels of a quad, as a chunk. Not by way of memory, where what was stored in
 parts could not be read whole until all stores before it are done. */
inline void repeatForChannels(int a, int b, int c, int d, v_int32 chunk[CHUNK_VECTORS])
{
#if CV_SIMD_WIDTH == 64
    const __m512i quads = _mm512_castsi128_si512(_mm_setr_epi32(a, b, c, d));
    chunk[0] = v_int32(_mm512_permutexvar_epi32(_mm512_setr_epi32(0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2, 2, 3, 3, 3, 3), quads));
#elif CV_SIMD_WIDTH == 32
    chunk[0] = v_int32(_mm256_setr_m128i(_mm_set1_epi32(a), _mm_set1_epi32(b)));
    chunk[1] = v_int32(_mm256_setr_m128i(_mm_set1_epi32(c), _mm_set1_epi32(d)));
#else
    chunk[0] = v_setall_s32(a);
    chunk[1] = v_setall_s32(b);
    chunk[2] = v_setall_s32(c);
    chunk[3] = v_setall_s32(d);
#endif
}

//! Weights of the left and right cells of a chunk of quads.
struct ColumnWeights
{
    v_int32 left[CHUNK_VECTORS], right[CHUNK_VECTORS];
    bool equal;  //!< whether all weights are 1

    //! @param first column; @param quads how many there are from it on, which may not fill the chunk.
    CV_ALWAYS_INLINE ColumnWeights(const Axis& axis, int first, int quads)
    {
        const Weights a(axis, first), b(axis, first + 2 * std::min(1, quads - 1));
        const Weights c(axis, first + 2 * std::min(2, quads - 1)), d(axis, first + 2 * std::min(3, quads - 1));
        repeatForChannels(a.first, b.first, c.first, d.first, left);
        repeatForChannels(a.second, b.second, c.second, d.second, right);
        equal = a.equal() & b.equal() & c.equal() & d.equal();
    }
};

//! Where the bits of a chunk go, two bytes for each plane.
struct PlaneRows
{
    uchar* first;
    size_t plane, row;  //!< from a plane or row to the next one, in bytes

    void store(int p, unsigned chunk) const { storeBytes(chunk, CHUNK / 8, first + p * plane); }
};

//! A chunk of quads and all those below it. WITH_PARENTS also stores the sums over quads.
template <typename Mapping, bool WITH_PARENTS, typename Cell>
inline void columnBits(QuadRows<Cell> quads, const ColumnWeights& columns, const int* edges, int step, int rows,
                       ParentRows sums, PlaneRows out)
{
    for (int r = 0; r < rows; r++)
    {
        const Weights heights(edges[step] - edges[0], edges[2 * step] - edges[step]);
        edges += 2 * step;
        unsigned chunk[Mapping::BITS] = {};
        for (int i = 0; i < CHUNK_VECTORS; i++)
        {
            v_int32 x[4];
            quads.load(i * LANES, x);
            if (WITH_PARENTS)
                sums.store(i * LANES, x);
            if (!columns.equal)
            {
                x[0] = x[0] * columns.left[i];
                x[1] = x[1] * columns.right[i];
                x[2] = x[2] * columns.left[i];
                x[3] = x[3] * columns.right[i];
            }
            if (!heights.equal())
            {
                const v_int32 t = vx_setall_s32(heights.first), b = vx_setall_s32(heights.second);
                x[0] = x[0] * t;
                x[1] = x[1] * t;
                x[2] = x[2] * b;
                x[3] = x[3] * b;
            }
            const Lanes<v_int32> weighted[4] = { x[0], x[1], x[2], x[3] };
            const Put put = { chunk, i * LANES };
            Mapping::map(weighted, put);
        }
        for (int plane = 0; plane < Mapping::BITS; plane++)
            out.store(plane, chunk[plane]);
        quads.next();
        sums.next();
        out.first += out.row;
    }
}

//! Appends a plane, `lanes` bits of which those of the channels in use are wanted.
inline void append(const uchar* plane, int lanes, int channels, BitWriter& out)
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
            const int count = std::min(lanes - first, (int)CHUNK) / GROUP_CHANNELS * channels;
            const uchar* p = plane + first / 8;
            out.append(dropLanes(p[0] | p[1] << 8, channels) & ((1u << count) - 1), count);
        }
}

//! Appends the comparisons of all quads of a window.
inline void append(PlaneRows planes, const Window& window, int bits, int channels, BitWriter& out)
{
    BitWriter writer = out;  // a copy that no store of a byte can change stays in registers
    for (int r = 0; r < window.rows; r++, planes.first += planes.row)
        for (int plane = 0; plane < bits; plane++)
            append(planes.first + plane * planes.plane, window.lanes(), channels, writer);
    out = writer;
}

//! The cells of one quad, a lane each for the channels.
template <typename Cell> class Quad
{
public:
    Quad(const CellGrid<Cell>& cells, int row_, int col_) : row(row_), col(col_)
    {
        for (int i = 0; i < 4; i++)
            x[i] = loadCell(cells.cell(row + i / 2, col + i % 2));
    }

    v_uint32x4 sum() const { return v_reinterpret_as_u32((x[0] + x[1]) + (x[2] + x[3])); }

    //! Weighted as LevelShape tells.
    template <typename Mapping, typename P> void map(const LevelShape& shape, const P& put) const
    {
        const Weights w(shape.x, col), h(shape.y, row);
        const Lanes<v_int32x4> weighted[4] = { x[0] * v_setall_s32(w.first * h.first),
                                               x[1] * v_setall_s32(w.second * h.first),
                                               x[2] * v_setall_s32(w.first * h.second),
                                               x[3] * v_setall_s32(w.second * h.second) };
        Mapping::map(weighted, put);
    }

private:
    const int row, col;
    v_int32x4 x[4];
};

//! The comparisons of rows of quads of less than a chunk.
template <typename Mapping, bool WITH_PARENTS, typename Cell>
void narrowComparisons(const CellGrid<Cell>& cells, const LevelShape& shape, const Window& window,
                       CellGrid<unsigned>& parents, PlaneRows out)
{
    for (int r = 0; r < window.rows; r++, out.first += out.row)
    {
        unsigned planes[Mapping::BITS] = {};
        for (int q = 0; q < window.quads; q++)
        {
            const Quad<Cell> quad(cells, window.dy + 2 * r, window.dx + 2 * q);
            if (WITH_PARENTS)
                v_store(parents.cell(r, q), quad.sum());
            const Put put = { planes, q * GROUP_CHANNELS };
            quad.template map<Mapping>(shape, put);
        }
        for (int plane = 0; plane < Mapping::BITS; plane++)
            out.store(plane, planes[plane]);
    }
}

//! The comparisons of a window.
template <typename Mapping, bool WITH_PARENTS, typename Cell>
void comparisons(const CellGrid<Cell>& cells, const LevelShape& shape, const Window& window,
                 CellGrid<unsigned>& parents, PlaneRows out)
{
    if (window.lanes() < CHUNK)
        return narrowComparisons<Mapping, WITH_PARENTS>(cells, shape, window, parents, out);
    const int* edges = shape.y.edges + window.dy * shape.y.step;
    for (int first = 0; first < window.lanes(); first += CHUNK, out.first += CHUNK / 8)
        columnBits<Mapping, WITH_PARENTS>(
            QuadRows<Cell>(cells, window.dy, window.dx, first),
            ColumnWeights(shape.x, window.dx + first / 2, window.quads - first / GROUP_CHANNELS), edges, shape.y.step,
            window.rows, ParentRows(parents, first), out);
}

template <typename Mapping, bool WITH_PARENTS, typename Cell>
void windowBits(const CellGrid<Cell>& cells, const LevelShape& shape, int index, CellGrid<unsigned>& parents,
                BitWriter& out)
{
    const Window window(shape.n, index);
    const int rowBytes = Mapping::BITS * window.planeBytes();
    uchar buffer[MAX_QUADS * Mapping::BITS * MAX_LANES / 8 + 8], *whole = 0;  // words are read beyond the last plane
    // Where all bits are in use and a row fills whole chunks, they need no shifting.
    if (!shape.chosen && shape.channels == GROUP_CHANNELS && window.lanes() % CHUNK == 0)
        whole = out.reserve(window.rows * rowBytes);
    const PlaneRows planes = { whole ? whole : buffer, (size_t)window.planeBytes(), (size_t)rowBytes };
    comparisons<Mapping, WITH_PARENTS>(cells, shape, window, parents, planes);
    if (shape.chosen)
        shape.chosen[index].append(buffer, out);
    else if (!whole)
        append(planes, window, Mapping::BITS, shape.channels, out);
}

template <typename Mapping, typename Cell>
void levelBits(const CellGrid<Cell>& cells, const LevelShape& shape, CellGrid<unsigned>& parents, BitWriter& out)
{
    if (shape.uses(0))
    {
        parents.create(shape.n / 2);
        windowBits<Mapping, true>(cells, shape, 0, parents, out);
    }
    else
        parentSums(cells, parents);
    for (int i = 1; i < Window::COUNT; i++)
        if (shape.uses(i))
            windowBits<Mapping, false>(cells, shape, i, parents, out);
}

#ifdef CV_CPU_DISPATCH_MODE
#define IIB_INSTRUCTION_SET CVAUX_STR(CV_CPU_DISPATCH_MODE)
#else
#define IIB_INSTRUCTION_SET "baseline"
#endif

template <typename Cell> struct Kernels
{
    template <typename Mapping> BitsKernels<Cell> visit() const
    {
        const BitsKernels<Cell> k = { levelBits<Mapping, Cell>, parentSums<Cell>,
                                      IIB_INSTRUCTION_SET };
        return k;
    }
};

#undef IIB_INSTRUCTION_SET

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
