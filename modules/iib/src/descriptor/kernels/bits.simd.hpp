// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#pragma once

#include "kernels.hpp"
#include "mappings.hpp"
#include "vectors.simd.hpp"

namespace cv { namespace iib {
CV_CPU_OPTIMIZATION_NAMESPACE_BEGIN
namespace {

//! Lanes that are mapped at a time, one for each channel of a quad.
constexpr int CHUNK = QuadPhase::CHUNK;

template <typename V> struct Chunk
{
    static constexpr int LANES = VTraits<V>::max_nlanes, VECTORS = CHUNK / LANES;
};

//! The group's bits, packed at the low end. @param comparisons readable for Group::SIZE bytes from the group's first.
inline unsigned bitsOf(const ChosenBits::Group& group, const uchar* comparisons)
{
    const uchar* const bytes = comparisons + group.byte;
#if IIB_LOOKS_UP_BYTES
    const v_uint8x16 masks = v_load(group.masks), found = lookUp(v_load(bytes), v_load(group.places));
    return (unsigned)v_signmask((found & masks) == masks);
#else
    unsigned bits = 0;
    for (int i = 0; i < group.count; i++)
        bits |= (unsigned)((bytes[group.places[i]] & group.masks[i]) != 0) << i;
    return bits;
#endif
}

//! Appends the chosen bits of a phase.
inline void appendChosen(const ChosenBits& chosen, const uchar* comparisons, BitAppender& out)
{
    freeUpperHalves();
    BitAppender writer = out;  // a copy, since stores to uchar* may alias `out`
    for (const ChosenBits::Group& group : chosen.groups())
        writer.append(bitsOf(group, comparisons), group.count);
    out = writer;
}

inline v_int32 loadCells(const ushort* p) { return v_reinterpret_as_s32(vx_load_expand(p)); }
inline v_int32 loadCells(const unsigned* p) { return v_reinterpret_as_s32(vx_load(p)); }

inline v_int32 repeated(int v, const v_int32&) { return vx_setall_s32(v); }

inline v_doubles loadCells(const double* p) { return loadDoubles(p); }
inline v_doubles repeated(int v, const v_doubles&) { return repeatedDouble(v); }

//! A vector whose comparisons give a bit for each lane.
template <typename V> struct Lanes
{
    V v;

    Lanes() {}
    Lanes(const V& vector) : v(vector) {}
};

template <typename V> inline Lanes<V> operator+(const Lanes<V>& a, const Lanes<V>& b) { return a.v + b.v; }
template <typename V> inline Lanes<V> operator-(const Lanes<V>& a, const Lanes<V>& b) { return a.v - b.v; }
template <typename V> inline Lanes<V> least(const Lanes<V>& a, const Lanes<V>& b) { return v_min(a.v, b.v); }
template <typename V> inline Lanes<V> greatest(const Lanes<V>& a, const Lanes<V>& b)
{
    return v_max(a.v, b.v);
}
template <typename V> inline unsigned operator>(const Lanes<V>& a, const Lanes<V>& b)
{
    return greaterMask(a.v, b.v);
}
template <typename V> inline unsigned operator>=(const Lanes<V>& a, const Lanes<V>& b)
{
    return greaterEqualMask(a.v, b.v);
}
template <typename V> inline unsigned operator==(const Lanes<V>& a, const Lanes<V>& b)
{
    return equalMask(a.v, b.v);
}

inline Lanes<v_int32> fourTimes(const Lanes<v_int32>& a) { return a.v << 2; }
inline Lanes<v_doubles> fourTimes(const Lanes<v_doubles>& a) { return a.v * repeatedDouble(4); }

//! floor(a / 4) serves as a / 4: an integer is greater than both or neither.
inline Lanes<v_int32> quarter(const Lanes<v_int32>& a) { return a.v >> 2; }
inline Lanes<v_doubles> quarter(const Lanes<v_doubles>& a) { return a.v * repeatedDouble(0.25); }

//! Collects comparisons, beginning at a lane.
struct Put
{
    unsigned* planes;
    int lane;

    void operator()(int plane, unsigned bits) const { planes[plane] |= bits << lane; }
};

//! The cells of a chunk of quads, and of the quads below it.
template <typename Cell> class QuadRows
{
public:
    typedef decltype(loadCells((const Cell*)0)) V;

    //! Begins with quads whose top left cells are in row dy and columns dx, dx + 2, ..., at value `first`.
    QuadRows(const CellGrid<Cell>& cells, int dy, int dx, int first)
        : left(cells.row(dy, dx) + first), right(cells.row(dy, 1 - dx) + dx * GROUP_CHANNELS + first),
          step(cells.rowStep())  // right of an odd column is an even one
    {
    }

    void load(int lane, V x[4]) const
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

//! Weights of a chunk of quads along a row.
template <typename V> struct ColumnWeights;

template <> struct ColumnWeights<v_doubles>
{
    v_doubles left[Chunk<v_doubles>::VECTORS], right[Chunk<v_doubles>::VECTORS];

    ColumnWeights(const Axis& axis, int x)
    {
        double lefts[CHUNK], rights[CHUNK];
        for (int lane = 0; lane < CHUNK; lane++)
        {
            const Weights weights(axis, x + lane / GROUP_CHANNELS * 2);
            lefts[lane] = weights.first;
            rights[lane] = weights.second;
        }
        for (int i = 0; i < Chunk<v_doubles>::VECTORS; i++)
        {
            left[i] = loadDoubles(lefts + i * Chunk<v_doubles>::LANES);
            right[i] = loadDoubles(rights + i * Chunk<v_doubles>::LANES);
        }
    }
};

template <> struct ColumnWeights<v_int32>
{
    v_int32 left[Chunk<v_int32>::VECTORS], right[Chunk<v_int32>::VECTORS];

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

constexpr int MAX_QUADS = 1 << (MAX_GRANULARITY - 1), MAX_LANES = MAX_QUADS * GROUP_CHANNELS;

template <typename Cell>
void parentSums(const CellGrid<Cell>& cells, CellGrid<typename BitsKernels<Cell>::Parent>& parents)
{
    typedef typename QuadRows<Cell>::V V;
    const int n = cells.size() / 2;
    parents.create(n);
    const size_t step = parents.rowStep();
    for (int first = 0; first < n * GROUP_CHANNELS; first += CHUNK)
    {
        QuadRows<Cell> quads(cells, 0, 0, first);
        auto *even = parents.row(0, 0) + first / 2, *odd = parents.row(0, 1) + first / 2;
        for (int r = 0; r < n; r++, quads.next(), even += step, odd += step)
            for (int lane = 0; lane < CHUNK; lane += Chunk<V>::LANES)
            {
                V x[4];
                quads.load(lane, x);
                storeAlternately(even, odd, lane, (x[0] + x[1]) + (x[2] + x[3]));
            }
    }
}

/** Compares all quads of a phase, a chunk and the quads below it at a time. WITH_PARENTS also stores the sums over quads.
 @param out comparisons in the order of QuadPhase. */
template <typename Mapping, bool WITH_PARENTS, typename Cell, typename Parent>
void compareQuads(const CellGrid<Cell>& cells, const LevelShape& shape, const CellEdges& edges,
        const QuadPhase& phase, CellGrid<Parent>& parents, uchar* out)
{
    typedef typename QuadRows<Cell>::V V;
    const Axis axis = {edges.x, shape.step};
    const size_t step = parents.rowStep(), planeBytes = phase.planeBytes();
    for (int first = 0; first < phase.lanes(); first += CHUNK, out += CHUNK / 8)
    {
        const ColumnWeights<V> columns(axis, phase.dx + first / 2);
        QuadRows<Cell> quads(cells, phase.dy, phase.dx, first);
        Parent *even = parents.row(0, 0) + first / 2, *odd = parents.row(0, 1) + first / 2;
        uchar* plane = out;
        const int* y = edges.y + phase.dy * shape.step;
        for (int r = 0; r < phase.rows; r++, y += 2 * shape.step, quads.next(), even += step, odd += step)
        {
            const Weights heights(y[shape.step] - y[0], y[2 * shape.step] - y[shape.step]);
            unsigned chunk[Mapping::BITS] = {};
            for (int i = 0; i < Chunk<V>::VECTORS && first + i * Chunk<V>::LANES < phase.lanes(); i++)
            {
                const int lane = i * Chunk<V>::LANES;
                V x[4], weights[] = {columns.left[i], columns.right[i], columns.left[i], columns.right[i]};
                quads.load(lane, x);
                if (WITH_PARENTS)
                    storeAlternately(even, odd, lane, (x[0] + x[1]) + (x[2] + x[3]));
                if (!heights.equal())  // the two rows are often equally high
                    for (int k = 0; k < 4; k++)
                        weights[k] = weights[k] * repeated(k < 2 ? heights.first : heights.second, V());
                const Lanes<V> weighted[4] = {
                        x[0] * weights[0], x[1] * weights[1], x[2] * weights[2], x[3] * weights[3]};
                const Put put = {chunk, lane};
                Mapping::map(weighted, put);
            }
            for (int p = 0; p < Mapping::BITS; p++, plane += planeBytes)
                storeBytes(chunk[p], CHUNK / 8, plane);
        }
    }
}

template <typename Mapping, bool WITH_PARENTS, typename Cell, typename Parent>
void writePhase(const CellGrid<Cell>& cells, const LevelShape& shape, const CellEdges& edges, int index,
        CellGrid<Parent>& parents, BitAppender& out)
{
    const QuadPhase phase(shape.n, index);
    const ChosenBits& chosen = shape.chosen[index];
    // readers of groups of chosen bits go beyond the last plane
    uchar buffer[MAX_QUADS * Mapping::BITS * MAX_LANES / 8 + ChosenBits::Group::SIZE];
    uchar* const whole = chosen.all() ? out.reserve(phase.rows * Mapping::BITS * phase.planeBytes()) : 0;
    compareQuads<Mapping, WITH_PARENTS>(cells, shape, edges, phase, parents, whole ? whole : buffer);
    if (!whole)
        appendChosen(chosen, buffer, out);
}

template <typename Mapping, typename Cell, typename Parent>
void writeLevel(const CellGrid<Cell>& cells, const LevelShape& shape, const CellEdges& edges,
        CellGrid<Parent>& parents, uchar* descriptor)
{
    BitWriter out(descriptor, shape.offset);
    parents.create(shape.n / 2);
    if (!shape.chosen[0].none())
        writePhase<Mapping, true>(cells, shape, edges, 0, parents, out);
    else
        parentSums(cells, parents);
    for (int i = 1; i < QuadPhase::COUNT; i++)
        if (!shape.chosen[i].none())
            writePhase<Mapping, false>(cells, shape, edges, i, parents, out);
}

// Mappings that the paper does not have.

//! Left > right, top > bottom, main > other diagonal.
struct HaarMapping
{
    static constexpr int BITS = 3;

    template <typename V, typename Put> static void map(const V x[4], const Put& put)
    {
        put(0, x[0] + x[2] > x[1] + x[3]);
        put(1, x[0] + x[1] > x[2] + x[3]);
        put(2, x[0] + x[3] > x[1] + x[2]);
    }
};

//! Each cell > the next, around the quad.
struct PairwiseMapping
{
    static constexpr int BITS = 4;

    template <typename V, typename Put> static void map(const V x[4], const Put& put)
    {
        put(0, x[0] > x[1]);
        put(1, x[1] > x[3]);
        put(2, x[3] > x[2]);
        put(3, x[2] > x[0]);
    }
};

//! In the order of IIB::Mapping.
template <typename Cell> BitsKernels<Cell> bitsKernels()
{
    typedef typename BitsKernels<Cell>::Parent Parent;
    return {{writeLevel<MeanMapping, Cell, Parent>, writeLevel<ExtremeMapping<true>, Cell, Parent>,
                    writeLevel<ExtremeMapping<false>, Cell, Parent>,
                    writeLevel<QuartileMapping, Cell, Parent>, writeLevel<SortMapping, Cell, Parent>,
                    writeLevel<HaarMapping, Cell, Parent>, writeLevel<PairwiseMapping, Cell, Parent>},
            parentSums<Cell>};
}

}  // namespace
CV_CPU_OPTIMIZATION_NAMESPACE_END
}}  // namespace cv::iib
