// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#ifndef OPENCV_IIB_DESCRIPTOR_KERNELS_BITS_QUADS_SIMD_HPP
#define OPENCV_IIB_DESCRIPTOR_KERNELS_BITS_QUADS_SIMD_HPP

// The cells of quads, their weights and the sums over them.

#include "bits_lanes.simd.hpp"

namespace cv {
namespace iib {

CV_CPU_OPTIMIZATION_NAMESPACE_BEGIN

namespace {

inline v_int32 loadCells(const ushort* p) { return v_reinterpret_as_s32(vx_load_expand(p)); }
inline v_int32 loadCells(const unsigned* p) { return v_reinterpret_as_s32(vx_load(p)); }

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
        const v_uint32 sums = v_reinterpret_as_u32((x[0] + x[1]) + (x[2] + x[3]));
        storeAlternately(even, odd, lane / GROUP_CHANNELS, sums);
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

//! Weights of a chunk of quads along a row.
struct ColumnWeights
{
    v_int32 left[CHUNK_VECTORS], right[CHUNK_VECTORS];

    //! @param x the first column.
    CV_ALWAYS_INLINE ColumnWeights(const Axis& axis, int x)
    {
        const int* const e = axis.edges + x * axis.step;
        const int s = axis.step;
        const v_int32x4 begin(e[0], e[2 * s], e[4 * s], e[6 * s]),
                end(e[2 * s], e[4 * s], e[6 * s], e[8 * s]);
        const v_int32x4 middle(e[s], e[3 * s], e[5 * s], e[7 * s]);
        const v_int32x4 lefts = middle - begin, rights = end - middle, same = lefts == rights;
        repeatEachFourTimes(v_select(same, v_setall_s32(1), rights), left);
        repeatEachFourTimes(v_select(same, v_setall_s32(1), lefts), right);
    }
};

}  // namespace

CV_CPU_OPTIMIZATION_NAMESPACE_END

}  // namespace iib
}  // namespace cv

#endif
