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

constexpr int MAX_QUADS = 1 << (MAX_GRANULARITY - 1), MAX_LANES = MAX_QUADS * GROUP_CHANNELS;

template <typename Cell>
void parentSums(const CellGrid<Cell>& cells, CellGrid<typename BitsKernels<Cell>::Parent>& parents)
{
    typedef typename QuadRows<Cell>::V V;
    const int n = cells.size() / 2;
    parents.create(n);
    for (int first = 0; first < n * GROUP_CHANNELS; first += CHUNK)
    {
        QuadRows<Cell> quads(cells, 0, 0, first);
        ParentRows<typename BitsKernels<Cell>::Parent> sums(parents, first);
        for (int r = 0; r < n; r++, quads.next(), sums.next())
            for (int lane = 0; lane < CHUNK; lane += Chunk<V>::LANES)
            {
                V x[4];
                quads.load(lane, x);
                sums.store(lane, x);
            }
    }
}

//! Compares the first `lanes` of a chunk of quads and all those below it. WITH_PARENTS also stores the sums over quads.
template <typename Mapping, bool WITH_PARENTS, typename Cell, typename V, typename Parent, typename Out>
inline void compareColumns(QuadRows<Cell> quads, const ColumnWeights<V>& columns, const int* edges, int step,
        int rows, int lanes, ParentRows<Parent> sums, Out out)
{
    for (int r = 0; r < rows; r++)
    {
        const Weights heights(edges[step] - edges[0], edges[2 * step] - edges[step]);
        edges += 2 * step;
        unsigned chunk[Mapping::BITS] = {};
        for (int i = 0; i < Chunk<V>::VECTORS && i * Chunk<V>::LANES < lanes; i++)
        {
            V x[4], weights[] = {columns.left[i], columns.right[i], columns.left[i], columns.right[i]};
            quads.load(i * Chunk<V>::LANES, x);
            if (WITH_PARENTS)
                sums.store(i * Chunk<V>::LANES, x);
            if (!heights.equal())  // the columns of a chunk are seldom equally long, the two rows often
                for (int k = 0; k < 4; k++)
                    weights[k] = weights[k] * repeated(k < 2 ? heights.first : heights.second, V());
            const Lanes<V> weighted[4] = {
                    x[0] * weights[0], x[1] * weights[1], x[2] * weights[2], x[3] * weights[3]};
            const Put put = {chunk, i * Chunk<V>::LANES};
            Mapping::map(weighted, put);
        }
        out.template storeRow<Mapping::BITS>(chunk);
        quads.next();
        sums.next();
    }
}

//! Compares all quads of a phase.
template <typename Mapping, bool WITH_PARENTS, typename Cell, typename Parent, typename Out>
void compareQuads(const CellGrid<Cell>& cells, const LevelShape& shape, const CellEdges& edges,
        const QuadPhase& phase, CellGrid<Parent>& parents, Out out)
{
    const Axis x = {edges.x, shape.step};
    const int* const rowEdges = edges.y + phase.dy * shape.step;
    for (int first = 0; first < phase.lanes(); first += CHUNK, out.nextChunk())
    {
        const ColumnWeights<typename QuadRows<Cell>::V> columns(x, phase.dx + first / 2);
        compareColumns<Mapping, WITH_PARENTS>(QuadRows<Cell>(cells, phase.dy, phase.dx, first), columns,
                rowEdges, shape.step, phase.rows, phase.lanes() - first, ParentRows<Parent>(parents, first),
                out);
    }
}

template <typename Mapping, bool WITH_PARENTS, typename Cell, typename Parent>
void writePhase(const CellGrid<Cell>& cells, const LevelShape& shape, const CellEdges& edges, int index,
        CellGrid<Parent>& parents, BitAppender& out)
{
    const QuadPhase phase(shape.n, index);
    if (phase.lanes() < CHUNK && shape.chosen.empty())
        return compareQuads<Mapping, WITH_PARENTS>(
                cells, shape, edges, phase, parents, ShortRowWriter(out, phase.lanes(), shape.channels));
    const int rowBytes = Mapping::BITS * phase.planeBytes();
    // words are read beyond the last plane
    uchar buffer[MAX_QUADS * Mapping::BITS * MAX_LANES / 8 + 8], *whole = 0;
    // Where all bits are in use and a row fills whole chunks, they need no shifting.
    if (shape.chosen.empty() && shape.channels == GROUP_CHANNELS && phase.lanes() % CHUNK == 0)
        whole = out.reserve(phase.rows * rowBytes);
    const PlaneRows planes = {whole ? whole : buffer, (size_t)phase.planeBytes(), (size_t)rowBytes};
    compareQuads<Mapping, WITH_PARENTS>(cells, shape, edges, phase, parents, planes);
    if (!shape.chosen.empty())
        appendChosen(shape.chosen[index], buffer, out);
    else if (!whole)
        append(planes, phase, Mapping::BITS, shape.channels, out);
}

template <typename Mapping, typename Cell, typename Parent>
void writeLevel(const CellGrid<Cell>& cells, const LevelShape& shape, const CellEdges& edges,
        CellGrid<Parent>& parents, uchar* descriptor)
{
    BitWriter out(descriptor, shape.offset);
    if (shape.uses(0))
        writePhase<Mapping, true>(cells, shape, edges, 0, parents, out);
    else
        parentSums(cells, parents);
    for (int i = 1; shape.phases >> i; i++)
        if (shape.uses(i))
            writePhase<Mapping, false>(cells, shape, edges, i, parents, out);
}

template <typename Mapping, typename Cell, typename Parent>
void writeLevels(const CellGrid<Cell>& cells, const LevelShape shapes[], const CellEdges& edges, int finest,
        int coarsest, CellGrid<Parent> sums[], uchar* descriptor)
{
    writeLevel<Mapping>(cells, shapes[finest], edges, sums[finest - 1], descriptor);
    for (int level = finest - 1; level >= coarsest; level--)
        writeLevel<Mapping>(sums[level], shapes[level], edges, sums[level - 1], descriptor);
}

template <typename Cell> struct BitsKernelsOf
{
    template <typename Mapping> BitsKernels<Cell> visit() const
    {
        const BitsKernels<Cell> k = {
                writeLevels<Mapping, Cell, typename BitsKernels<Cell>::Parent>, parentSums<Cell>};
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
