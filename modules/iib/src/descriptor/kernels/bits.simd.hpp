// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#ifndef OPENCV_IIB_DESCRIPTOR_KERNELS_BITS_SIMD_HPP
#define OPENCV_IIB_DESCRIPTOR_KERNELS_BITS_SIMD_HPP

#include "bits_planes.simd.hpp"
#include "bits_quads.simd.hpp"
#include "kernels.hpp"
#include "mappings.hpp"

namespace cv {
namespace iib {

CV_CPU_OPTIMIZATION_NAMESPACE_BEGIN

namespace {

enum
{
    MAX_QUADS = 1 << (MAX_GRANULARITY - 1),
    MAX_LANES = MAX_QUADS * GROUP_CHANNELS
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

inline v_int32x4 loadCell(const ushort* p) { return v_reinterpret_as_s32(v_load_expand(p)); }
inline v_int32x4 loadCell(const unsigned* p) { return v_reinterpret_as_s32(v_load(p)); }

template <typename Cell>
int centre(const CellGrid<Cell>& cells, const LevelShape& shape, const CellEdges& edges,
        CellGrid<unsigned>& centred)
{
    const int n = shape.n;
    const Axis x = {edges.x, shape.step}, y = {edges.y, shape.step};
    const float area = (float)(x.edge(n) - x.edge(0)) * (float)(y.edge(n) - y.edge(0));
    v_float32x4 total = v_setzero_f32();
    for (int r = 0; r < n; r++)
        for (int c = 0; c < n; c++)
            total += v_cvt_f32(loadCell(cells.cell(r, c)));
    // rounding it changes no bit: the same number is taken from all means, and only their order counts
    const v_int32x4 mean = v_round(total * v_setall_f32(area > 0 ? 1 / area : 0));
    v_uint32x4 largest = v_setzero_u32();
    centred.create(n);
    for (int r = 0; r < n; r++)
        for (int c = 0; c < n; c++)
        {
            const v_int32x4 v = loadCell(cells.cell(r, c)) - mean * v_setall_s32(x.length(c) * y.length(r));
            v_store(centred.cell(r, c), v_reinterpret_as_u32(v));
            largest = v_max(largest, v_abs(v));
        }
    return (int)v_reduce_max(largest);
}

//! A chunk of quads and all those below it. WITH_PARENTS also stores the sums over quads.
template <typename Mapping, bool WITH_PARENTS, typename Cell, typename Out>
inline void columnBits(QuadRows<Cell> quads, const ColumnWeights& columns, const int* edges, int step,
        int rows, ParentRows sums, Out out)
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
            // the columns of a chunk are seldom equally long, the two rows often
            x[0] = x[0] * columns.left[i];
            x[1] = x[1] * columns.right[i];
            x[2] = x[2] * columns.left[i];
            x[3] = x[3] * columns.right[i];
            if (!heights.equal())
            {
                const v_int32 t = vx_setall_s32(heights.first), b = vx_setall_s32(heights.second);
                x[0] = x[0] * t;
                x[1] = x[1] * t;
                x[2] = x[2] * b;
                x[3] = x[3] * b;
            }
            const Lanes<v_int32> weighted[4] = {x[0], x[1], x[2], x[3]};
            const Put put = {chunk, i * LANES};
            Mapping::map(weighted, put);
        }
        out.template storeRow<Mapping::BITS>(chunk);
        quads.next();
        sums.next();
    }
}

//! The comparisons of a phase.
template <typename Mapping, bool WITH_PARENTS, typename Cell, typename Out>
void comparisons(const CellGrid<Cell>& cells, const LevelShape& shape, const CellEdges& edges,
        const QuadPhase& phase, CellGrid<unsigned>& parents, Out out)
{
    const Axis x = {edges.x, shape.step};
    const int* const rowEdges = edges.y + phase.dy * shape.step;
    for (int first = 0; first < phase.lanes(); first += CHUNK, out.nextChunk())
    {
        const ColumnWeights columns(x, phase.dx + first / 2);
        columnBits<Mapping, WITH_PARENTS>(QuadRows<Cell>(cells, phase.dy, phase.dx, first), columns, rowEdges,
                shape.step, phase.rows, ParentRows(parents, first), out);
    }
}

template <typename Mapping, bool WITH_PARENTS, typename Cell>
void phaseBits(const CellGrid<Cell>& cells, const LevelShape& shape, const CellEdges& edges, int index,
        CellGrid<unsigned>& parents, BitAppender& out)
{
    const QuadPhase phase(shape.n, index);
    if (phase.lanes() < CHUNK && shape.chosen.empty())
        return comparisons<Mapping, WITH_PARENTS>(
                cells, shape, edges, phase, parents, ShortRowWriter(out, phase.lanes(), shape.channels));
    const int rowBytes = Mapping::BITS * phase.planeBytes();
    // words are read beyond the last plane
    uchar buffer[MAX_QUADS * Mapping::BITS * MAX_LANES / 8 + 8], *whole = 0;
    // Where all bits are in use and a row fills whole chunks, they need no shifting.
    if (shape.chosen.empty() && shape.channels == GROUP_CHANNELS && phase.lanes() % CHUNK == 0)
        whole = out.reserve(phase.rows * rowBytes);
    const PlaneRows planes = {whole ? whole : buffer, (size_t)phase.planeBytes(), (size_t)rowBytes};
    comparisons<Mapping, WITH_PARENTS>(cells, shape, edges, phase, parents, planes);
    if (!shape.chosen.empty())
        appendChosen(shape.chosen[index], buffer, out);
    else if (!whole)
        append(planes, phase, Mapping::BITS, shape.channels, out);
}

template <typename Mapping, typename Cell>
void levelBits(const CellGrid<Cell>& cells, const LevelShape& shape, const CellEdges& edges,
        CellGrid<unsigned>& parents, uchar* descriptor)
{
    BitWriter out(descriptor, shape.offset);
    if (shape.uses(0))
        phaseBits<Mapping, true>(cells, shape, edges, 0, parents, out);
    else
        parentSums(cells, parents);
    for (int i = 1; shape.phases >> i; i++)
        if (shape.uses(i))
            phaseBits<Mapping, false>(cells, shape, edges, i, parents, out);
}

template <typename Mapping, typename Cell>
void levelsBits(const CellGrid<Cell>& cells, const LevelShape shapes[], const CellEdges& edges, int finest,
        int coarsest, CellGrid<unsigned> sums[], uchar* descriptor)
{
    levelBits<Mapping>(cells, shapes[finest], edges, sums[finest - 1], descriptor);
    for (int level = finest - 1; level >= coarsest; level--)
        levelBits<Mapping>(sums[level], shapes[level], edges, sums[level - 1], descriptor);
}

template <typename Cell> struct BitsKernelsOf
{
    template <typename Mapping> BitsKernels<Cell> visit() const
    {
        const BitsKernels<Cell> k = {levelsBits<Mapping, Cell>, parentSums<Cell>, centre<Cell>};
        return k;
    }
};

template <typename Cell> BitsKernels<Cell> bitsKernels(int mapping)
{
    return visitMapping(mapping, BitsKernelsOf<Cell>());
}

}  // namespace

CV_CPU_OPTIMIZATION_NAMESPACE_END

}  // namespace iib
}  // namespace cv

#endif
