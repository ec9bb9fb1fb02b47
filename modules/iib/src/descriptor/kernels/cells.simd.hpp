// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "../../common/simd.hpp"

#include "cell_grid.hpp"
#include "../support_region.hpp"

namespace cv {
namespace iib {

CV_CPU_OPTIMIZATION_NAMESPACE_BEGIN

CellEdgesFunc getCellEdgesFunc();
CellSumsFunc<ushort>::Type getCellSumsFunc(ushort);
CellSumsFunc<unsigned>::Type getCellSumsFunc(unsigned);

#ifndef CV_CPU_OPTIMIZATION_DECLARATIONS_ONLY

namespace {

/* n is a power of two, so that the edges of a level are a subset of those of the next. The compiler makes vectors of
 the loop, with this file's instruction set. */
void cellEdges(const SupportRegion& region, int n, Size image, int* x, int* y)
{
    const double step = region.side / n;
    for (int k = 0; k < n; k++)
    {
        x[k] = edgeAt(region.x + step * k, image.width);
        y[k] = edgeAt(region.y + step * k, image.height);
    }
    x[n] = edgeAt(region.x + step * n, image.width);
    y[n] = edgeAt(region.y + step * n, image.height);
    for (int k = n + 1; k < paddedEdges(n); k++)
        x[k] = x[n];
}

/* Half a 512-bit vector at most: the offsets of a whole one are too many for the registers. */
#if CV_SIMD_WIDTH == 16
template <typename Sum> struct CornersOf
{
    typedef v_uint16x8 Vector;
};
template <> struct CornersOf<unsigned>
{
    typedef v_uint32x4 Vector;
};
#else
template <typename Sum> struct CornersOf
{
    typedef v_uint16x16 Vector;
};
template <> struct CornersOf<unsigned>
{
    typedef v_uint32x8 Vector;
};
#endif

// Differences modulo 2^16 or 2^32, as the sums.
template <typename V> inline V subtract(const V& a, const V& b) { return a - b; }
inline v_uint16x8 subtract(const v_uint16x8& a, const v_uint16x8& b) { return v_sub_wrap(a, b); }
#if CV_SIMD_WIDTH != 16
inline v_uint16x16 subtract(const v_uint16x16& a, const v_uint16x16& b) { return v_sub_wrap(a, b); }
#endif

inline v_uint16x8 loadCorner(const ushort* corner) { return v_load_low(corner); }
inline v_uint32x4 loadCorner(const unsigned* corner) { return v_load(corner); }

/* As many corners as make a vector, of every other column, and those after the first one of a vector, and one more.
 Not v_lut_quads: gather instructions are slow on many machines. */
#if CV_SIMD_WIDTH == 16
inline v_uint16x8 loadCorners(const ushort* row, const size_t* at)
{
    return v_load_halves(row + at[0], row + at[2]);
}
inline v_uint32x4 loadCorners(const unsigned* row, const size_t* at) { return v_load(row + at[0]); }

inline v_uint16x8 nextCorners(const v_uint16x8& corners, const ushort* more)
{
    return v_rotate_right<GROUP_CHANNELS>(corners, loadCorner(more));
}

inline v_uint32x4 nextCorners(const v_uint32x4&, const unsigned* more) { return loadCorner(more); }
#else
inline __m128i loadTwo(const ushort* first, const ushort* second)
{
    return _mm_castpd_si128(_mm_loadh_pd(_mm_load_sd((const double*)first), (const double*)second));
}

inline v_uint16x16 loadCorners(const ushort* row, const size_t* at)
{
    return v_uint16x16(
            _mm256_setr_m128i(loadTwo(row + at[0], row + at[2]), loadTwo(row + at[4], row + at[6])));
}

inline v_uint32x8 loadCorners(const unsigned* row, const size_t* at)
{
    return v_uint32x8(_mm256_setr_m128i(loadCorner(row + at[0]).val, loadCorner(row + at[2]).val));
}

template <typename V, typename Sum> inline V nextCorners(const V& corners, const Sum* more)
{
    const __m256i next = _mm256_castsi128_si256(loadCorner(more).val);
#if CV_SIMD_WIDTH == 64
    return V(_mm256_alignr_epi64(next, corners.val, GROUP_CHANNELS * (int)sizeof(Sum) / 8));
#else
    return v_rotate_right<GROUP_CHANNELS>(corners, V(next));
#endif
}
#endif

/* From a row of corners: their differences, which are sums over a row of left and of right cells and all above. */
template <typename V> struct RowSums
{
    V left, right;

    template <typename Sum, size_t N> CV_ALWAYS_INLINE RowSums(const Sum* row, const size_t (&at)[N])
    {
        const V even = loadCorners(row, at), odd = loadCorners(row, at + 1);
        left = subtract(odd, even);
        right = subtract(nextCorners(even, row + at[N - 1]), odd);
    }
};

//! The row of the ring that ends above row y of the image.
template <typename Sum> class RowFinder
{
public:
    RowFinder(const IntegralRows<Sum>& rows, int top)
        : data(rows.data), step(rows.step), count(rows.count), shift((top - rows.origin.y) % count - top)
    {
    }

    const Sum* operator()(int y) const
    {
        const int place = y + shift;
        return data + (place < count ? place : place - count) * step;
    }

private:
    const Sum* const data;
    const size_t step;
    const int count, shift;
};

template <typename Sum>
void cellSums(
        const IntegralRows<Sum>& rows, const int* xEdges, const int* yEdges, int n, CellGrid<Sum>& cells)
{
    typedef typename CornersOf<Sum>::Vector V;
    enum
    {
        COLUMNS = 2 * VTraits<V>::max_nlanes / GROUP_CHANNELS
    };
    const RowFinder<Sum> row(rows, yEdges[0]);
    AutoBuffer<const Sum*, 64> lines(n);
    for (int r = 0; r < n; r++)
        lines[r] = row(yEdges[r + 1]);

    cells.create(n);
    const size_t step = cells.row(0, 1) - cells.row(0, 0);
    for (int c = 0; c < n; c += COLUMNS)
    {
        size_t at[COLUMNS + 1];
        for (int i = 0; i <= COLUMNS; i++)
            at[i] = (size_t)(xEdges[c + i] - rows.origin.x) * GROUP_CHANNELS;
        Sum* out = cells.row(0, 0) + c / 2 * GROUP_CHANNELS;
        RowSums<V> above(row(yEdges[0]), at);
        for (const Sum *const *line = lines.data(), *const *end = line + n; line != end; line++)
        {
            const RowSums<V> below(*line, at);
            v_store(out, subtract(below.left, above.left));
            v_store(out + step, subtract(below.right, above.right));
            out += 2 * step;
            above = below;
        }
    }
}

}  // namespace

CellEdgesFunc getCellEdgesFunc() { return cellEdges; }

CellSumsFunc<ushort>::Type getCellSumsFunc(ushort) { return cellSums<ushort>; }

CellSumsFunc<unsigned>::Type getCellSumsFunc(unsigned) { return cellSums<unsigned>; }

#endif

CV_CPU_OPTIMIZATION_NAMESPACE_END

}  // namespace iib
}  // namespace cv
