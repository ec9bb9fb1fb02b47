// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// The cells of quads, their weights and the sums over them. Included by bits.simd.hpp.

#include "bits.hpp"

namespace cv {
namespace iib {
CV_CPU_OPTIMIZATION_NAMESPACE_BEGIN
namespace {

inline v_int32 loadCells(const ushort* p) { return v_reinterpret_as_s32(vx_load_expand(p)); }
inline v_int32 loadCells(const unsigned* p) { return v_reinterpret_as_s32(vx_load(p)); }
inline v_int32x4 loadCell(const ushort* p) { return v_reinterpret_as_s32(v_load_expand(p)); }
inline v_int32x4 loadCell(const unsigned* p) { return v_reinterpret_as_s32(v_load(p)); }

//! The cells of a chunk of quads, and of those in the rows below it.
template <typename Cell> class QuadRows
{
public:
    //! Begins with quads whose top left cells are in row dy and columns dx, dx + 2, ..., at value `first`.
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

/* Four numbers, each repeated for the channels of a quad, as a chunk. Not by way of memory, where what was stored in
 parts could not be read whole until all stores before it are done. */
inline void repeatForChannels(int a, int b, int c, int d, v_int32 chunk[CHUNK_VECTORS])
{
#if CV_SIMD_WIDTH == 64
    const __m512i quads = _mm512_castsi128_si512(_mm_setr_epi32(a, b, c, d));
    const __m512i places = _mm512_setr_epi32(0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2, 2, 3, 3, 3, 3);
    chunk[0] = v_int32(_mm512_permutexvar_epi32(places, quads));
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
        equal = ((a.first ^ a.second) | (b.first ^ b.second) | (c.first ^ c.second) | (d.first ^ d.second)) == 0;
    }
};

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

}  // namespace
CV_CPU_OPTIMIZATION_NAMESPACE_END
}  // namespace iib
}  // namespace cv
